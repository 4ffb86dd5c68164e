#include "app/console/seeds_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/json_file.h"
#include "core/spoken_list.h"
#include "segment/selection/click_selection.h"

namespace splatcut {

namespace {

SeedLabel label_from(const std::string& text, const std::string& where) {
  if (text == "object") return SeedLabel::kObject;
  if (text == "rest") return SeedLabel::kRest;
  throw Error(where, "the label \"" + text + "\" is unknown", "Use object or rest");
}

// Numbers of an option, and what is meant by them.
template <std::size_t N>
struct Marked {
  std::array<float, N> number{};
  SeedLabel label = SeedLabel::kObject;
};

template <std::size_t N>
Marked<N> parse_marked(const std::string& option, const std::string& text, const std::string& what,
                       const std::string& form) {
  const std::string where = option + " " + text;
  const Error fault(where, "is not " + what, "Write it as " + form + " or " + form + ":rest");
  Marked<N> marked;
  const char* at = text.c_str();
  for (std::size_t i = 0; i < N; ++i) {
    if (i > 0 && *at++ != ',') throw fault;
    char* end = nullptr;
    marked.number[i] = std::strtof(at, &end);
    if (end == at) throw fault;
    at = end;
  }
  if (*at == '\0') return marked;
  if (*at != ':') throw fault;
  marked.label = label_from(at + 1, where);
  return marked;
}

// Letters to change, add or take away until both are the same (Levenshtein).
std::size_t letters_apart(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t before = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = before + (a[i] != b[j]);
      before = std::exchange(row[j + 1], std::min({changed, row[j] + 1, row[j + 1] + 1}));
    }
  }
  return row.back();
}

void refuse_unknown_fields(const nlohmann::json& object, const std::vector<std::string>& known,
                           const std::string& what, const std::string& where) {
  if (!object.is_object()) return;      // said where it is read
  constexpr std::size_t kMisspelt = 2;  // letters
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    const auto apart = [&key = key](const std::string& name) { return letters_apart(key, name); };
    const std::string nearest = *std::ranges::min_element(known, {}, apart);
    throw Error(where, fmt::format("{} has no field \"{}\"", what, key),
                apart(nearest) <= kMisspelt ? fmt::format("\"{}\" is one", nearest)
                                            : "It takes " + spoken_list(known));
  }
}

}  // namespace

void refuse_unknown_seeds(const nlohmann::json& seeds, const std::string& where, bool in_list) {
  std::vector<std::string> known = {"clicks", "boxes", "scribbles", "camera", "choice"};
  if (in_list)
    known.insert(known.end(), {"name", "object"});
  else
    known.insert(known.end(), {"objects", "labels"});  // make-scene writes the names of labels, too
  refuse_unknown_fields(seeds, known, in_list ? "an object" : "it", where);
  const auto each = [&](const char* list, const char* what, const std::vector<std::string>& fields) {
    if (seeds.is_object() && seeds.contains(list) && seeds.at(list).is_array())
      for (const nlohmann::json& one : seeds.at(list)) refuse_unknown_fields(one, fields, what, where);
  };
  each("clicks", "a click", {"x", "y", "label", "scale"});
  each("boxes", "a box", {"corners", "label", "scale"});
  each("scribbles", "a scribble", {"points", "radius_px", "label"});
}

int size_step_from_json(const nlohmann::json& stroke, const char* key, const std::string& where) {
  if (!stroke.contains(key)) return 0;
  const nlohmann::json& step = stroke.at(key);
  if (!step.is_number_integer() || step < -kMostSizeSteps || step > kMostSizeSteps)
    throw Error(where, fmt::format("\"{0}\" is no whole number from -{1} to {1}", key, kMostSizeSteps));
  return step.get<int>();
}

void check_stroke(const Stroke& stroke, const std::string& where) {
  constexpr float kFarthestPx = 1e6f;
  if (!(stroke.radius_px > 0 && stroke.radius_px < kFarthestPx))
    throw Error(where, "\"radius_px\" is no radius", "Give pixels, 3 for one");
  if (stroke.points_px.empty()) throw Error(where, "a scribble has no point", "Give some as [[x, y], ...]");
  if (stroke.is_box() && stroke.points_px.size() != 2) throw Error(where, "a box has two opposite corners");
  for (const glm::vec2& p : stroke.points_px)
    if (!(std::abs(p.x) < kFarthestPx && std::abs(p.y) < kFarthestPx))
      throw Error(where, "a point lies outside of any picture");
}

glm::vec2 point_from_json(const nlohmann::json& point, const std::string& where) {
  if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
    throw Error(where, "a point is " + json_text(point), "Write it as [x, y], in pixels");
  return {point[0].get<float>(), point[1].get<float>()};
}

Stroke box_from_json(const nlohmann::json& box, SeedLabel label, const std::string& where) {
  const nlohmann::json& corners = box.at("corners");
  if (!corners.is_array() || corners.size() != 2)
    throw Error(where, "a box has two opposite corners", "Write them as [[x0, y0], [x1, y1]], in pixels");
  return box_around(point_from_json(corners[0], where), point_from_json(corners[1], where), label);
}

Strokes strokes_from_json(const nlohmann::json& seeds, const std::string& where) {
  Strokes strokes;
  try {
    if (seeds.contains("boxes"))
      for (const auto& b : seeds.at("boxes")) {
        strokes.push_back(box_from_json(b, label_from(b.value("label", "object"), where), where));
        strokes.back().size_step = size_step_from_json(b, "scale", where);
      }
    if (seeds.contains("clicks"))
      for (const auto& c : seeds.at("clicks")) {
        strokes.push_back(click({c.at("x").get<float>(), c.at("y").get<float>()},
                                label_from(c.value("label", "object"), where)));
        strokes.back().size_step = size_step_from_json(c, "scale", where);
      }
    if (seeds.contains("scribbles"))
      for (const auto& s : seeds.at("scribbles")) {
        Stroke stroke{label_from(s.value("label", "object"), where), s.value("radius_px", 3.0f), {}};
        for (const auto& p : s.at("points")) stroke.points_px.push_back(point_from_json(p, where));
        strokes.push_back(std::move(stroke));
      }
  } catch (const nlohmann::json::exception& error) {
    throw Error(where, std::string("the seeds do not have the expected form (") + fault_of(error) + ")");
  }
  for (const Stroke& stroke : strokes) check_stroke(stroke, where);
  return strokes;
}

int choice_from_json(const nlohmann::json& seeds, const std::string& where) {
  if (!seeds.is_object() || !seeds.contains("choice")) return 0;
  const nlohmann::json& choice = seeds.at("choice");
  if (!choice.is_number_integer() || choice < 1 || choice > kMostMeanings)
    throw Error(where, fmt::format("\"choice\" is no number from 1 to {}", kMostMeanings),
                "1 is what the first click means most likely");
  return choice.get<int>() - 1;
}

Stroke parse_click(const std::string& text) {
  const Marked<2> pixel = parse_marked<2>("--click", text, "a pixel", "x,y");
  return click({pixel.number[0], pixel.number[1]}, pixel.label);
}

Stroke parse_box(const std::string& text) {
  const Marked<4> box = parse_marked<4>("--box", text, "a box", "x0,y0,x1,y1");
  Stroke stroke = box_around({box.number[0], box.number[1]}, {box.number[2], box.number[3]}, box.label);
  check_stroke(stroke, "--box " + text);
  return stroke;
}

}  // namespace splatcut
