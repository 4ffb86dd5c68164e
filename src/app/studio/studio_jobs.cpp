// Loading, preparing, cutting, autosave: what the worker does for the document.
#include <fmt/format.h>

#include <algorithm>

#include "app/studio/studio.h"
#include "app/studio/words.h"
#include "app/studio/work_file.h"
#include "core/error.h"
#include "scene/raster/rasterizer.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/doubts.h"

namespace splatcut {

namespace {

constexpr int kViewsToLookFrom = 6;
constexpr int kThumbnailWidth = 160;
// Changes of the view alone are saved later: the view changes all the time.
constexpr double kAutosaveAfterSeconds = 2, kAutosaveViewAfterSeconds = 10;
constexpr std::size_t kCoarseFrom = 300000;  // Gaussians; fewer are drawn fast enough as they are

// The view's picture with its mask in the object's colour; dark where the view does not count.
Image<Rgba8> thumbnail(const GaussianCloud& cloud, const GivenView& view, bool counts, const Rgb8& colour,
                       const Job& job) {
  const Camera camera = limited_to_width(view.camera, kThumbnailWidth);
  const RasterOutput drawn = rasterize(cloud, camera, {}, job);
  Image<Rgba8> out(camera.width_px, camera.height_px);
  const glm::vec3 hue = glm::vec3(colour[0], colour[1], colour[2]) / 255.0f;
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int u = x * view.mask.width() / out.width(), v = y * view.mask.height() / out.height();
      glm::vec3 c = drawn.colour.at(x, y);
      c = view.mask.at(u, v) ? glm::mix(c, hue, 0.55f) : 0.75f * c;
      if (!counts) c *= 0.35f;
      const glm::vec3 b = glm::clamp(c, 0.0f, 1.0f) * 255.0f;
      out.at(x, y) = {static_cast<std::uint8_t>(b.r), static_cast<std::uint8_t>(b.g),
                      static_cast<std::uint8_t>(b.b), 255};
    }
  return out;
}

// Before there is time for pictures: the mask alone.
Image<Rgba8> mask_card(const ViewReport& view, const Rgb8& colour) {
  const Camera camera = limited_to_width(view.camera, kThumbnailWidth);
  Image<Rgba8> out(camera.width_px, camera.height_px, Rgba8{38, 40, 44, 255});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      if (view.mask.at(x * view.mask.width() / out.width(), y * view.mask.height() / out.height()))
        out.at(x, y) = {colour[0], colour[1], colour[2], 255};
  return out;
}

ViewCard card_of(const ViewReport& view, Image<Rgba8> picture) {
  return {view.camera,
          view.used,
          view.confidence,
          view.reason,
          std::make_shared<const Image<Rgba8>>(std::move(picture)),
          false,
          0};
}

// After clicks, fast and default use no views around the object; these views are made for the person to
// check.
bool looked_around_by_none(const CutResult& result, const CutRequest& request, const CutSettings& settings) {
  return result.outcome == Outcome::kDone && settings.orbit.views <= 0 && !request.first_mask;
}

// The message after a cut: the size of the object, and what the last step changed.
std::string what_changed(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after,
                         double seconds) {
  std::size_t was = 0, is = 0, added = 0;
  for (std::size_t g = 0; g < after.size(); ++g) {
    was += before[g];
    is += after[g];
    added += after[g] && !before[g];
  }
  const std::size_t removed = was + added - is;
  if (was == 0) return fmt::format("{} Gaussians cut out in {:.1f} s", grouped(is), seconds);
  if (added + removed == 0) return fmt::format("{} Gaussians, as before", grouped(is));
  return fmt::format("{} Gaussians, {} added and {} removed in {:.1f} s", grouped(is), grouped(added),
                     grouped(removed), seconds);
}

std::shared_ptr<const ClickMeanings> meanings_of(const CutRequest& request, const CutResult& result) {
  if (result.meanings.empty()) return nullptr;
  ClickMeanings out{.key = key_of_first_stroke(request),
                    .choice = request.choice,
                    .sizes = result.sizes,
                    .likeliest_size = result.likeliest_size,
                    .size = result.size,
                    .camera = {},
                    .outlines = {},
                    .smaller = {},
                    .larger = {}};
  const auto first = std::ranges::find_if(request.strokes, marks_object);
  if (first != request.strokes.end()) out.camera = first->camera;
  const auto in_camera = [&](const Mask& mask) {
    if (mask.size() == 0) return std::vector<std::vector<glm::vec2>>();
    auto borders = outlines(mask);
    const float factor = static_cast<float>(out.camera.width_px) / static_cast<float>(mask.width());
    for (auto& border : borders)
      for (glm::vec2& point : border) point *= factor;
    return borders;
  };
  for (const Mask& mask : result.meanings) out.outlines.push_back(in_camera(mask));
  out.smaller = in_camera(result.smaller);
  out.larger = in_camera(result.larger);
  return std::make_shared<const ClickMeanings>(std::move(out));
}

}  // namespace

void Studio::perform(const OpenScene& c) {
  const std::uint64_t serial = next_scene_serial_++;
  say(Message::Kind::kInfo, "Opening " + c.path.filename().string());
  tasks_.cancel(TaskKind::kCut);
  tasks_.submit(TaskKind::kLoad, [this, path = c.path, axes = c.spz_axes, serial](const Job& job) {
    std::optional<WorkFile> file;
    if (is_work_file(path)) file = read_work_file(path);
    const std::shared_ptr<OpenedScene> opened_scene =
        file ? open_scene(file->scene, job, file->spz_axes) : open_scene(path, job, axes);
    if (job.cancelled()) return;
    opened_scene->serial = serial;
    std::optional<RestoredWork> work;
    if (file) work = restored(*file, *opened_scene->scene, opened_scene->hash);
    const std::string note = work ? work->warning : axes ? "" : opened_scene->scene->axes_note;
    tasks_.post([this, opened_scene, work, note, work_path = file ? path : std::filesystem::path()] {
      opened(opened_scene, work, work_path);
      for (const std::string& note_of_file : {opened_scene->scene->left_out, opened_scene->scene->oddity})
        if (!note_of_file.empty()) say(Message::Kind::kInfo, note_of_file);
      if (!note.empty()) say(Message::Kind::kInfo, note);
    });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

void Studio::opened(const std::shared_ptr<OpenedScene>& scene, const std::optional<RestoredWork>& work,
                    const std::filesystem::path& work_path) {
  tasks_.cancel(TaskKind::kPrepare);
  prepared_ = nullptr;
  session_ = nullptr;
  coarse_ = nullptr;
  runs_.clear();
  runs_before_.clear();
  given_up_.clear();
  cutting_object_ = 0;
  picture_.reset();
  hover_.reset();
  declined_offer_.clear();
  tools_.abandon();
  volume_seen_.reset();
  view_.display = DisplayMode::kWhole;
  view_.heat = false;
  view_.tool = Tool::kClick;
  view_.fly_speed = 1;
  view_.operation = SetOperation::kAdd;
  view_.brush_px = std::min(view_.brush_px, kMostKeptBrushPx);
  highlight_floaters_ = false;
  scene_ = scene;
  work_path_ = is_work_file(work_path) && work_path.parent_path() != options_.state_folder
                   ? work_path
                   : std::filesystem::path();
  Document start;
  start.up_world = scene->up_world;
  history_.reset(work ? work->document : start, work ? "Open work" : "Open scene");
  camera_.reset(scene->bounds, history_.now().up_world);
  if (!scene->cameras.empty() || scene->first_view) {
    camera_.go_to(scene->cameras.empty() ? *scene->first_view : scene->cameras.front());
    camera_.finish_transition();
  }
  if (work && work->view) camera_.set_pose(*work->view);
  if (work_path == restorable_) restorable_.clear();
  document_changed();
  autosaved_serial_ = saved_serial_ = document_serial_;
  autosaved_pose_ = camera_.pose();
  if (work && work_path_.empty()) autosaved_serial_ = saved_serial_ = 0;  // restored: nowhere else yet
  ++view_serial_;
  const Scene& s = *scene->scene;
  std::string text = fmt::format("{}: {} Gaussians, SH degree {}", s.path.filename().string(),
                                 grouped(s.cloud.size()), s.cloud.sh_degree);
  if (s.dropped) text += fmt::format(", {} unusable rows left out", grouped(s.dropped));
  text += scene->cameras.empty()
              ? std::string(". Does it lean or stand on its head? Set what is up under View")
              : fmt::format(", {} cameras (N, P)", scene->cameras.size());
  say(Message::Kind::kDone, text);
  tasks_.submit(TaskKind::kPrepare, [this, scene](const Job& job) {
    if (scene->cloud->size() >= kCoarseFrom)
      tasks_.post([this, scene, coarse = std::make_shared<const CoarseCloud>(coarse_cloud(*scene->cloud))] {
        if (scene == scene_) coarse_ = coarse;
      });
    auto prepared = prepare(*scene, job, options_.cache);
    if (job.cancelled()) return;
    auto session = std::make_shared<Session>(session_scene(*scene, prepared));
    session->make_ready(preset("default"), job);
    tasks_.post([this, scene, prepared, session] {
      if (scene != scene_) return;
      prepared_ = prepared;
      session_ = session;
    });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

// Made once per state of the document: it holds all strokes.
const std::string& Studio::wanted_key(const ObjectItem& object) {
  if (wanted_serial_ != document_serial_) wanted_keys_.clear();
  wanted_serial_ = document_serial_;
  std::string& key = wanted_keys_[object.id];
  if (key.empty()) key = cut_key(document(), object);
  return key;
}

// The document decides what to compute: a stale object is cut, a cut that is no longer needed is stopped.
void Studio::schedule_cut() {
  if (!scene_ || !prepared_) return;
  if (cutting_object_ != 0) {
    const ObjectItem* object = document().find(cutting_object_);
    if (object && wanted_key(*object) == cutting_key_) return;
    tasks_.cancel(TaskKind::kCut);
    end_running_cut();
  }
  for (const ObjectItem& object : document().objects) {
    const std::string& key = wanted_key(object);
    if (!is_stale(object, key) || given_up_.contains(key)) continue;
    start_cut(object);
    return;
  }
}

void Studio::start_cut(const ObjectItem& object) {
  forget_runs();
  if (const CutRun* before = cut_run(object.id);
      before && before->result && before->key != wanted_key(object))
    keep_run(object.id, *before);
  cutting_object_ = object.id;
  cutting_key_ = wanted_key(object);
  CutRun& run = runs_[object.id];
  std::vector<ViewCard> before = std::move(run.views);
  auto kept = run.meanings;
  run = CutRun{};
  run.meanings = std::move(kept);
  run.running = true;
  run.key = cutting_key_;
  run.views = std::move(before);
  run.started_s = clock_s_;
  const auto failed = [this, id = object.id, key = cutting_key_] { give_up_cut(id, key); };
  const TaskThread::Order cut_task_order(TaskKind::kCut, failed);
  tasks_.cancel(TaskKind::kHover);
  tasks_.submit(cut_task_order, [this, request = cut_request(document(), object),
                                 settings = cut_settings(document(), object), session = session_,
                                 id = object.id, key = cutting_key_, colour = object.colour, scene = scene_,
                                 heat = view_.heat](const Job& job) {
    const auto start = std::chrono::steady_clock::now();
    const auto ms = [start] {
      return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    std::size_t shown = 0;  // views of this cut
    const auto snapshot = [&](CutPhase, const CutResult& result) {
      if (result.labels.empty()) return;
      const double first_ms = shown == 0 ? ms() : 0;
      const auto meanings = shown == 0 ? meanings_of(request, result) : nullptr;
      std::vector<ViewCard> fresh;
      for (; shown < result.views.size(); ++shown)
        fresh.push_back(card_of(result.views[shown], mask_card(result.views[shown], colour)));
      tasks_.post([this, id, key, first_ms, meanings, scene, fresh = std::move(fresh), stages = result.stages,
                   labels = make_flags(result.labels)] {
        if (scene != scene_ || cutting_object_ != id || cutting_key_ != key) return;
        CutRun& now = runs_[id];
        if (first_ms > 0) {
          now.first_mask_ms = first_ms;
          now.meanings = meanings;
          now.views.clear();  // those of the cut before
        }
        for (const ViewCard& card : fresh) {
          now.views.push_back(card);
          now.views.back().serial = next_card_serial_++;
        }
        now.stages = stages;
        now.preview = labels;
        ++view_serial_;
      });
    };
    const auto result = std::make_shared<const CutResult>(session->cut(request, settings, job, snapshot));
    if (result->outcome == Outcome::kCancelled || job.cancelled()) return;
    const double total_ms = ms();
    tasks_.post([this, id, key, scene, result, labels = make_flags(result->labels), total_ms,
                 meanings = meanings_of(request, *result), doubts = doubts_of(*result)] {
      if (scene != scene_) return;
      CutRun& now = runs_[id];
      if (now.key != key) return;
      now.running = false;
      now.preview = nullptr;
      now.result = result;
      if (!result->stages.empty()) now.stages = result->stages;
      now.total_ms = total_ms;
      now.meanings = meanings;
      note_sizes();
      now.doubts = doubts;
      if (now.first_mask_ms == 0) now.first_mask_ms = total_ms;
      if (cutting_object_ == id && cutting_key_ == key) cutting_object_ = 0;
      const std::vector<std::uint8_t> labels_before = this->labels(id);
      history_.set_cut(id, key, labels);
      document_changed();
      const ObjectItem* item = document().find(id);
      if (!item) return;
      if (result->outcome == Outcome::kNothingFound)
        say(Message::Kind::kRefused, item->name + ": " + result->reason);
      else
        say(doubts.empty() ? Message::Kind::kDone : Message::Kind::kInfo,
            fmt::format("{}: {}{}", item->name,
                        what_changed(labels_before, this->labels(id), total_ms / 1000),
                        !doubts.empty() ? ". But " + doubts.front()
                        : result->ambiguous && tools_.scale_armed()
                            ? ". Not all of it? Turn the wheel for another size"
                            : ""));
    });
    // The cutout is on the screen; the rest is for looking at.
    std::shared_ptr<const std::vector<float>> likelihood;
    if (heat)
      likelihood = std::make_shared<const std::vector<float>>(session->likelihood_of(request, settings, job));
    std::vector<ViewCard> cards;
    for (const ViewReport& view : result->views) {
      if (job.cancelled()) return;
      job.progress("pictures of the views",
                   static_cast<double>(cards.size()) / static_cast<double>(result->views.size()));
      cards.push_back(
          card_of(view, thumbnail(*scene->cloud, {view.camera, view.mask}, view.used, colour, job)));
    }
    if (looked_around_by_none(*result, request, settings))
      for (const GivenView& view : session->look_around(request, *result, settings, kViewsToLookFrom, job)) {
        if (job.cancelled()) return;
        const auto picture =
            std::make_shared<const Image<Rgba8>>(thumbnail(*scene->cloud, view, true, colour, job));
        cards.push_back({.camera = view.camera, .used = false, .picture = picture, .only_to_look = true});
      }
    if (job.cancelled()) return;
    tasks_.post([this, id, key, scene, cards = std::move(cards), likelihood]() mutable {
      CutRun* of_key = scene == scene_ ? run_of(id, key) : nullptr;
      if (!of_key) return;
      of_key->views = std::move(cards);
      for (ViewCard& card : of_key->views) card.serial = next_card_serial_++;
      if (likelihood) of_key->likelihood = likelihood;
      ++view_serial_;
    });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

// If the labels have arrived already, only pictures or the heat map failed: the cut stands.
void Studio::give_up_cut(ObjectId id, const std::string& key) {
  if (cutting_object_ != id || cutting_key_ != key) return;
  given_up_.insert(key);
  end_running_cut();
}

void Studio::request_likelihood() {
  const ObjectItem* object = document().active_object();
  if (!view_.heat || !object || cutting_object_ != 0 || object->cut_key.empty() || !prepared_ ||
      tasks_.busy(TaskKind::kCut))
    return;
  CutRun& run = runs_[object->id];
  if ((run.likelihood || run.likelihood_failed) && run.key == object->cut_key) return;
  if (is_stale(*object, wanted_key(*object))) return;
  run.key = object->cut_key;
  run.likelihood_failed = false;
  const auto failed = [this, id = object->id, key = object->cut_key, scene = scene_] {
    if (scene == scene_ && runs_[id].key == key) runs_[id].likelihood_failed = true;
  };
  const TaskThread::Order heat_map_order(TaskKind::kCut, failed);
  tasks_.submit(heat_map_order, [this, request = cut_request(document(), *object),
                                 settings = cut_settings(document(), *object), session = session_,
                                 id = object->id, key = object->cut_key, scene = scene_](const Job& job) {
    job.progress("likelihood", 0);
    // Kept from the last cut, or computed again.
    auto likelihood =
        std::make_shared<const std::vector<float>>(session->likelihood_of(request, settings, job));
    if (job.cancelled()) return;
    tasks_.post([this, id, key, scene, likelihood] {
      if (scene != scene_ || runs_[id].key != key) return;
      runs_[id].likelihood = likelihood;
      ++view_serial_;
    });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

void Studio::autosave(double seconds) {
  if (options_.state_folder.empty() || !scene_ || cutting_object_ != 0) return;
  const bool changed = autosaved_serial_ != document_serial_;
  const bool looks_elsewhere = unsaved() && autosaved_pose_ != camera_.pose();
  if (!changed && !looks_elsewhere) return;
  autosave_wait_s_ += seconds;
  if (autosave_wait_s_ < (changed ? kAutosaveAfterSeconds : kAutosaveViewAfterSeconds)) return;
  autosave_wait_s_ = 0;
  autosaved_serial_ = document_serial_;
  autosaved_pose_ = camera_.pose();
  const std::filesystem::path path = options_.state_folder / kAutosave;
  if (restorable_ == path) {  // the offered autosave must not be overwritten
    std::error_code trouble;
    std::filesystem::rename(path, options_.state_folder / kAutosaveBefore, trouble);
    if (!trouble) restorable_ = options_.state_folder / kAutosaveBefore;
  }
  const auto before = options_.state_folder / kAutosaveBefore;
  tasks_.submit(TaskKind::kAutosave,
                [path, restored = restorable_ == before ? std::filesystem::path() : before,
                 document = document(), view = camera_.pose(), scene = scene_](const Job&) {
                  std::filesystem::create_directories(path.parent_path());
                  write_work_file(path, *scene->scene, scene->hash, document, view);
                  std::error_code ignored;  // what was restored is in the file now
                  if (!restored.empty()) std::filesystem::remove(restored, ignored);
                });
}

}  // namespace splatcut
