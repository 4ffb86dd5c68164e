#include "app/console/seeds_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "core/json_file.h"
#include "segment/selection/click_selection.h"

namespace splatcut {

namespace {

SeedLabel label_from(const std::string& text, const std::string& where) {
  if (text == "object") return SeedLabel::kObject;
  if (text == "rest") return SeedLabel::kRest;
  throw Error(where, "the label \"" + text + "\" is unknown", "Use object or rest");
}

}  // namespace

void check_stroke(const Stroke& stroke, const std::string& where) {
  constexpr float kFarthestPx = 1e6f;
  if (!(stroke.radius_px > 0 && stroke.radius_px < kFarthestPx))
    throw Error(where, "\"radius_px\" is no radius", "Give pixels, 3 for one");
  for (const glm::vec2& p : stroke.points_px)
    if (!(std::abs(p.x) < kFarthestPx && std::abs(p.y) < kFarthestPx))
      throw Error(where, "a point lies outside of any picture");
}

Strokes strokes_from_json(const nlohmann::json& seeds, const std::string& where) {
  Strokes strokes;
  try {
    if (seeds.contains("clicks") && seeds.at("clicks").is_array())
      for (const auto& c : seeds.at("clicks"))
        strokes.push_back(click({c.at("x").get<float>(), c.at("y").get<float>()},
                                label_from(c.value("label", "object"), where)));
    if (seeds.contains("scribbles"))
      for (const auto& s : seeds.at("scribbles")) {
        Stroke stroke{label_from(s.at("label"), where), s.value("radius_px", 3.0f), {}};
        for (const auto& p : s.at("points"))
          stroke.points_px.emplace_back(p.at(0).get<float>(), p.at(1).get<float>());
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
  float x = 0, y = 0;
  int used = 0;
  const std::string where = "--click " + text;
  if (std::sscanf(text.c_str(), "%f,%f%n", &x, &y, &used) != 2)
    throw Error(where, "is not a pixel", "Write it as x,y or x,y:rest");
  const std::string tail = text.substr(static_cast<std::size_t>(used));
  if (tail.empty()) return click({x, y}, SeedLabel::kObject);
  if (tail[0] != ':') throw Error(where, "is not a pixel", "Write it as x,y or x,y:rest");
  return click({x, y}, label_from(tail.substr(1), where));
}

}  // namespace splatcut
