#include "app/lab/any_view_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>

#include "app/lab/scene_copies.h"
#include "app/lab/study/study_tables.h"
#include "app/measure/click_sheet.h"

namespace splatcut {

namespace {

// All views of a scene with truth are drawn after each click: nine of 1008 pixels and 300,000 Gaussians.
constexpr std::size_t kMostKeptBytes = std::size_t{2} << 30;
constexpr std::array kCounts = {1, 2, 3, 5, 8, 10};
constexpr std::array kReplayed = {1, 3, 5, 10};
constexpr std::array kZooms = {0.4f, 0.6f, 1.0f, 2.0f, 4.0f};

template <class Value>
double mean_of(const std::vector<AnyViewSession>& sessions, Value value) {
  double sum = 0;
  for (const AnyViewSession& s : sessions) sum += value(s);
  return sum / static_cast<double>(sessions.size());
}

// "sheet_fox_view_0012_draw_1".
std::string sheet_name(const std::string& scene, const AnyViewSession& session) {
  std::string name = "sheet_" + scene + "_" + session.start;
  if (session.draw) name += fmt::format("_draw_{}", session.draw);
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  return name;
}

nlohmann::json session_json(const AnyViewSession& s) {
  nlohmann::json clicks = nlohmann::json::array();
  for (std::size_t i = 0; i < s.clicks.size(); ++i) {
    const Stroke& stroke = s.clicks[i].stroke;
    const glm::vec2 at = stroke.points_px.front();
    clicks.push_back({{"view", s.clicks[i].camera.name},
                      {"x", at.x},
                      {"y", at.y},
                      {"label", stroke.label == SeedLabel::kObject ? "object" : "rest"},
                      {"obeyed", s.obeyed[i] ? true : false}});
    if (stroke.size_step != 0) clicks.back()["scale"] = stroke.size_step;
    if (stroke.is_box()) clicks.back()["to"] = {stroke.points_px[1].x, stroke.points_px[1].y};
  }
  return {{"start", s.start},           {"draw", s.draw},
          {"choice", s.choice},         {"iou_after", s.iou_after},
          {"obeyed", s.obeyed_share()}, {"worst_fall", s.worst_fall()},
          {"clicks", clicks},           {"doubts", s.doubts}};
}

// Steps of one scene's work, for the bar.
class Steps {
 public:
  Steps(std::string name, std::size_t all, const Job& job) : name_(std::move(name)), all_(all), job_(job) {}
  void next() {
    job_.progress(name_, static_cast<double>(done_++) / static_cast<double>(std::max<std::size_t>(1, all_)));
  }

 private:
  std::string name_;
  std::size_t all_, done_ = 0;
  const Job& job_;
};

nlohmann::json zoom_json(const GaussianCloud& cloud, const AnyViewWorld& world,
                         const std::vector<AnyViewStart>& starts, Steps* steps, const Job& job) {
  nlohmann::json zoom;
  for (const float factor : kZooms) {
    double sum = 0;
    int n = 0;
    for (const AnyViewStart& start : starts) {
      if (job.cancelled()) return zoom;
      steps->next();
      const std::optional<ViewClick> moved = zoomed_click(cloud, start, factor);
      if (!moved) continue;
      sum += iou_of_clicks(world, std::span(&*moved, 1), job);
      ++n;
    }
    zoom[fmt::format("{:g}", factor)] = n ? nlohmann::json(sum / n) : nullptr;
  }
  return zoom;
}

// Of the first strokes: what is offered, and the best of that.
nlohmann::json offers_json(const AnyViewWorld& world, const std::vector<AnyViewStart>& starts, Steps* steps,
                           const Job& job) {
  double likeliest = 0, best = 0, offered = 0;
  for (const AnyViewStart& start : starts) {
    steps->next();
    const std::vector<double> iou = iou_of_meanings(world, {start.camera, start.first}, job);
    if (job.cancelled()) return {};
    likeliest += iou.front();
    best += std::ranges::max(iou);
    offered += static_cast<double>(iou.size());
  }
  const auto count = static_cast<double>(starts.size());
  return {{"likeliest", likeliest / count}, {"best", best / count}, {"offered", offered / count}};
}

// The case on a copy of its scene, which must outlive it.
EvaluationCase on_copy(const EvaluationCase& test, const SceneCopy& copy) {
  EvaluationCase there = test;
  there.cloud = &copy.scene.cloud;
  there.kept_views = nullptr;
  there.prepare.cache = {};    // nobody opens a copy again
  there.truth_labels.clear();  // the truth is the original's pictures
  return there;
}

// IoU by number of clicks told, session and copy.
using CopiesIou = std::map<int, std::vector<std::vector<double>>>;

// The sessions' clicks on one copy of the scene; adds a value to each list.
void replay_on_copy(const LoadedCase& loaded, int number, const std::vector<TruthView>& views,
                    const std::vector<AnyViewSession>& sessions, const std::string& preset, Steps* steps,
                    const Job& job, CopiesIou* iou) {
  const SceneCopy copy = scene_copy(loaded.scene, number, job);
  if (job.cancelled()) return;
  const EvaluationCase& test = loaded.test;
  EvaluationCase there = on_copy(test, copy);
  KeptViews kept(copy.scene.cloud, kMostKeptBytes);
  there.kept_views = &kept;
  const AnyViewWorld world = window_world(there, views, std::make_shared<WindowCut>(there, preset));
  for (std::size_t s = 0; s < sessions.size(); ++s)
    for (auto& [clicks, of_sessions] : *iou) {
      if (job.cancelled()) return;
      steps->next();
      const std::size_t told = std::min(static_cast<std::size_t>(clicks), sessions[s].clicks.size());
      of_sessions[s].push_back(iou_of_clicks(world, std::span(sessions[s].clicks).first(told), job));
    }
}

// of_sessions: IoU on each copy, by session; on_scene: on the scene itself.
nlohmann::json spread_json(const std::vector<std::vector<double>>& of_sessions,
                           const std::vector<double>& on_scene) {
  double median = 0, least = 0, spread = 0;
  std::vector<double> differences;
  for (std::size_t s = 0; s < of_sessions.size(); ++s) {
    const auto [low, high] = std::ranges::minmax(of_sessions[s]);
    median += quantile(of_sessions[s], 0.5);
    least += low;
    spread += high - low;
    for (const double v : of_sessions[s]) differences.push_back(std::abs(v - on_scene[s]));
  }
  const auto n = static_cast<double>(of_sessions.size());
  return {{"median", median / n},
          {"least", least / n},
          {"spread", spread / n},
          {"difference", quantile(differences, 0.5)},
          {"most_difference", std::ranges::max(differences)}};
}

nlohmann::json perturb_json(const LoadedCase& loaded, const std::vector<TruthView>& views,
                            const std::vector<AnyViewSession>& sessions, const AnyViewOptions& options,
                            Steps* steps, const Job& job) {
  CopiesIou iou;
  for (const int clicks : kReplayed)
    if (clicks <= options.clicks) iou[clicks].resize(sessions.size());
  for (int c = 0; c < options.copies && !job.cancelled(); ++c)
    replay_on_copy(loaded, c, views, sessions, options.preset, steps, job, &iou);
  if (job.cancelled()) return {};
  nlohmann::json perturb = {{"copies", options.copies}};
  for (const auto& [clicks, of_sessions] : iou) {
    std::vector<double> on_scene;
    for (const AnyViewSession& s : sessions)
      on_scene.push_back(s.iou_after[static_cast<std::size_t>(clicks) - 1]);
    perturb[std::to_string(clicks)] = spread_json(of_sessions, on_scene);
  }
  return perturb;
}

// The number at a pointer, or a dash.
std::string text(const nlohmann::json& j, const std::string& at, const char* form) {
  const nlohmann::json::json_pointer pointer(at);
  return j.contains(pointer) && j.at(pointer).is_number()
             ? fmt::format(fmt::runtime(form), j.at(pointer).get<double>())
             : std::string("-");
}

void print_sessions(const std::vector<nlohmann::json>& rows) {
  fmt::print(
      "\nany view: image IoU over all views after n clicks, mean over sessions; 10 %, least: of sessions\n");
  fmt::print("{:<16} {:>5}", "scene", "views");
  for (const int k : kCounts) fmt::print(" {:>5}", k);
  for (const char* head :
       {"10 % 3", "least3", "10 %10", "leas10", "NoC85", "NoC90", "obeyed", "fall", "most", "ms"})
    fmt::print(" {:>6}", head);
  fmt::print("\n");
  for (const nlohmann::json& r : rows) {
    fmt::print("{:<16} {:>5}", r.value("name", ""), text(r, "/any_view/views", "{:.3g}"));
    for (const int k : kCounts)
      fmt::print(" {:>5}", text(r, fmt::format("/any_view/iou_after_clicks/{}", k), "{:.3f}"));
    for (const char* k : {"3", "10"})
      for (const char* which : {"p10", "least"})
        fmt::print(" {:>6}", text(r, fmt::format("/any_view/{}/iou_after_clicks/{}", which, k), "{:.3f}"));
    for (const auto& [key, form] : {std::pair{"noc85", "{:.1f}"},
                                    {"noc90", "{:.1f}"},
                                    {"obeyed", "{:.2f}"},
                                    {"worst_fall", "{:.3f}"},
                                    {"most_fall", "{:.3f}"},
                                    {"ms_per_click", "{:.0f}"}})
      fmt::print(" {:>6}", text(r, std::string("/any_view/") + key, form));
    fmt::print("\n");
  }
}

void print_offers(const std::vector<nlohmann::json>& rows) {
  fmt::print("\noffers: the likeliest meaning of the first click, the best that is offered, how many are\n");
  for (const nlohmann::json& r : rows) {
    fmt::print("{:<16}", r.value("name", ""));
    for (const char* what : {"likeliest", "best", "offered"})
      fmt::print(" {:>6}", text(r, std::string("/offers/") + what, "{:.3f}"));
    fmt::print("\n");
  }
}

void print_zoom(const std::vector<nlohmann::json>& rows) {
  fmt::print("\nzoom: the first click alone from so many times the distance\n{:<16}", "scene");
  for (const float f : kZooms) fmt::print(" {:>6g}", f);
  fmt::print("\n");
  for (const nlohmann::json& r : rows) {
    fmt::print("{:<16}", r.value("name", ""));
    for (const float f : kZooms) fmt::print(" {:>6}", text(r, fmt::format("/zoom/{:g}", f), "{:.3f}"));
    fmt::print("\n");
  }
}

void print_copies(const std::vector<nlohmann::json>& rows) {
  fmt::print(
      "\nthe same clicks on copies of the scene: median, least, spread; median and largest difference\n");
  for (const nlohmann::json& r : rows)
    for (const int k : kReplayed) {
      if (!r.at("perturb").contains(std::to_string(k))) continue;
      fmt::print("{:<16} {:>2} clicks", r.value("name", ""), k);
      for (const char* what : {"median", "least", "spread", "difference", "most_difference"})
        fmt::print(" {:>6}", text(r, fmt::format("/perturb/{}/{}", k, what), "{:.3f}"));
      fmt::print("\n");
    }
}

}  // namespace

nlohmann::json sessions_json(const std::vector<AnyViewSession>& sessions, int clicks) {
  nlohmann::json j, list = nlohmann::json::array();
  for (const int k : kCounts) {
    if (k > clicks) continue;
    std::vector<double> values;
    for (const AnyViewSession& s : sessions) values.push_back(s.iou_after[static_cast<std::size_t>(k) - 1]);
    const std::string key = std::to_string(k);
    double sum = 0;
    for (const double v : values) sum += v;
    j["iou_after_clicks"][key] = sum / static_cast<double>(values.size());
    j["least"]["iou_after_clicks"][key] = quantile(values, 0);
    j["p10"]["iou_after_clicks"][key] = quantile(values, 0.1);
  }
  j["noc85"] = mean_of(sessions, [](const auto& s) { return clicks_to(s.iou_after, 0.85); });
  j["noc90"] = mean_of(sessions, [](const auto& s) { return clicks_to(s.iou_after, 0.90); });
  double clicked = 0, obeyed = 0, obeyed_pixel = 0, most_fall = 0;
  for (const AnyViewSession& s : sessions) {
    clicked += static_cast<double>(s.clicks.size());
    obeyed += static_cast<double>(std::ranges::count(s.obeyed, true));
    obeyed_pixel += static_cast<double>(std::ranges::count(s.obeyed_pixel, true));
    most_fall = std::max(most_fall, s.worst_fall());
    list.push_back(session_json(s));
  }
  j["obeyed"] = obeyed / clicked;
  j["obeyed_pixel"] = obeyed_pixel / clicked;
  j["worst_fall"] = mean_of(sessions, [](const auto& s) { return s.worst_fall(); });
  j["most_fall"] = most_fall;
  j["ms_per_click"] = mean_of(sessions, [](const auto& s) { return s.ms_per_click; });
  j["clicks"] = clicks;
  j["sessions"] = std::move(list);
  return j;
}

nlohmann::json any_view_json(const LoadedCase& loaded, const AnyViewOptions& options, const Job& job) {
  EvaluationCase scene = loaded.test;
  KeptViews kept(*scene.cloud, kMostKeptBytes);
  scene.kept_views = &kept;
  const Job silent{job.stop, {}};
  const std::vector<TruthView> views = truth_views(scene);
  const AnyViewWorld world = window_world(scene, views, std::make_shared<WindowCut>(scene, options.preset));
  const auto starts_of_draw = [&](int draw) {
    std::vector<AnyViewStart> starts = any_view_starts(
        scene, views, {.box_margin = options.box_margin, .draw = static_cast<std::uint64_t>(draw)});
    if (options.starts > 0 && std::ssize(starts) > options.starts)
      starts.resize(static_cast<std::size_t>(options.starts));
    return starts;
  };
  const std::vector<AnyViewStart> steady = starts_of_draw(0);
  const std::size_t sessions_asked = steady.size() * static_cast<std::size_t>(options.draws);
  Steps steps(scene.name,
              sessions_asked + (options.zoom ? kZooms.size() * steady.size() : 0) +
                  (options.choices ? steady.size() : 0) +
                  kReplayed.size() * steady.size() * static_cast<std::size_t>(options.copies),
              job);
  std::vector<AnyViewSession> sessions;
  for (int draw = 0; draw < options.draws; ++draw)
    for (const AnyViewStart& start : starts_of_draw(draw)) {
      steps.next();
      sessions.push_back(any_view_session(
          world, start, options.clicks,
          {static_cast<std::uint64_t>(draw), options.choices, options.sizes, options.near, options.details},
          silent));
      if (job.cancelled()) return {};
      if (options.on_sheet)
        options.on_sheet(sheet_name(scene.name, sessions.back()),
                         click_sheet(*scene.cloud, world, sessions.back(), silent));
    }
  nlohmann::json result = {{"any_view", sessions_json(sessions, options.clicks)}};
  result["any_view"]["views"] = views.size();
  if (options.choices) result["offers"] = offers_json(world, steady, &steps, silent);
  if (options.zoom) result["zoom"] = zoom_json(*scene.cloud, world, steady, &steps, silent);
  sessions.resize(steady.size());  // of the steady hand
  if (options.copies > 0) result["perturb"] = perturb_json(loaded, views, sessions, options, &steps, job);
  return result;
}

void print_any_view(const nlohmann::json& result) {
  std::vector<nlohmann::json> rows = result.at("scenes");
  rows.push_back(result.at("mean"));
  print_sessions(rows);
  if (rows.back().contains("offers")) print_offers(rows);
  if (rows.back().contains("zoom")) print_zoom(rows);
  if (rows.back().contains("perturb")) print_copies(rows);
}

}  // namespace splatcut
