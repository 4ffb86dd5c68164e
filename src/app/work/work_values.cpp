#include "app/work/work_values.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "app/console/seeds_file.h"
#include "core/error.h"

namespace splatcut {

using nlohmann::json;

json list(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

glm::vec3 vec3_from(const json& j) {
  return {j.at(0).get<float>(), j.at(1).get<float>(), j.at(2).get<float>()};
}

glm::vec3 direction_from(const json& j) {
  const glm::vec3 up = vec3_from(j);
  if (!(glm::length(up) > 0) || !std::isfinite(glm::length(up))) throw Error("up", "is no direction");
  return up;
}

json camera_json(const Camera& c) {
  json rotation = json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) rotation.push_back(c.camera_from_world_rotation[column][row]);
  return {{"name", c.name},
          {"width", c.width_px},
          {"height", c.height_px},
          {"fx", c.fx_px},
          {"fy", c.fy_px},
          {"cx", c.cx_px},
          {"cy", c.cy_px},
          {"camera_from_world_rotation", rotation},
          {"camera_from_world_translation", list(c.camera_from_world_translation)}};
}

Camera camera_from(const json& j) {
  constexpr int kMostPixels = 1 << 15;
  Camera c;
  c.name = j.value("name", "");
  c.width_px = j.at("width");
  c.height_px = j.at("height");
  if (c.width_px < 1 || c.height_px < 1 || c.width_px > kMostPixels || c.height_px > kMostPixels)
    throw Error("camera", fmt::format("a picture of {} x {} pixels is impossible", c.width_px, c.height_px));
  c.fx_px = j.at("fx");
  c.fy_px = j.at("fy");
  c.cx_px = j.at("cx");
  c.cy_px = j.at("cy");
  if (!(c.fx_px > 0 && c.fy_px > 0) || !std::isfinite(c.fx_px + c.fy_px + c.cx_px + c.cy_px))
    throw Error("camera", fmt::format("focal lengths {} and {}, principal point {}, {}", c.fx_px, c.fy_px,
                                      c.cx_px, c.cy_px));
  const json& rotation = j.at("camera_from_world_rotation");
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      c.camera_from_world_rotation[column][row] = rotation.at(static_cast<std::size_t>(3 * row + column));
  c.camera_from_world_translation = vec3_from(j.at("camera_from_world_translation"));
  return c;
}

json pose_json(const CameraPose& pose) {
  const glm::quat& q = pose.camera_from_world;
  return {{"camera_from_world", {q.w, q.x, q.y, q.z}},
          {"position", list(pose.position_world)},
          {"distance", pose.distance},
          {"fov_y_rad", pose.fov_y_rad}};
}

CameraPose pose_from(const json& j) {
  constexpr float kUnit = 1e-3f;  // how far from one a rotation may be
  const json& q = j.at("camera_from_world");
  CameraPose pose;
  pose.camera_from_world = {q.at(0).get<float>(), q.at(1).get<float>(), q.at(2).get<float>(),
                            q.at(3).get<float>()};
  pose.position_world = vec3_from(j.at("position"));
  pose.distance = j.at("distance");
  pose.fov_y_rad = j.at("fov_y_rad");
  if (!(std::abs(glm::length(pose.camera_from_world) - 1) < kUnit) ||
      !std::isfinite(glm::length(pose.position_world)) ||
      !(pose.distance > 0 && std::isfinite(pose.distance)) ||
      !(pose.fov_y_rad > 0 && pose.fov_y_rad < glm::pi<float>()))
    throw Error("view", "is no place to look from");
  return pose;
}

json strokes_json(const Strokes& strokes) {
  json out = json::array();
  for (const Stroke& s : strokes) {
    json points = json::array();
    for (const glm::vec2& p : s.points_px) points.push_back({p.x, p.y});
    out.push_back({{"kind", s.is_box() ? "box" : "path"},
                   {"label", s.label == SeedLabel::kObject ? "object" : "rest"},
                   {"radius_px", s.radius_px},
                   {"size_step", s.size_step},
                   {"points", points}});
  }
  return out;
}

Strokes strokes_from(const json& j) {
  Strokes strokes;
  for (const json& s : j) {
    const std::string label = s.at("label");
    if (label != "object" && label != "rest")
      throw Error("stroke", "the label \"" + label + "\" is unknown", "Use object or rest");
    Stroke stroke{label == "object" ? SeedLabel::kObject : SeedLabel::kRest, s.at("radius_px"), {}};
    const std::string kind = s.at("kind");
    if (kind != "path" && kind != "box")
      throw Error("stroke", "the kind \"" + kind + "\" is unknown", "Use path or box");
    if (kind == "box") stroke.kind = StrokeKind::kBox;
    stroke.size_step = size_step_from_json(s, "size_step", "stroke");
    for (const json& p : s.at("points"))
      stroke.points_px.emplace_back(p.at(0).get<float>(), p.at(1).get<float>());
    check_stroke(stroke, "stroke");
    strokes.push_back(std::move(stroke));
  }
  return strokes;
}

// [value, run, value, run, ...] over the rows of the file.
json runs_json(const Flags& flags, const Scene& scene) {
  if (!flags) return nullptr;
  std::vector<std::uint8_t> rows(scene.file_rows, 0);
  for (std::size_t g = 0; g < flags->size(); ++g) rows[scene.cloud.file_row[g]] = (*flags)[g];
  json out = json::array();
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin;
    while (end < rows.size() && rows[end] == rows[begin]) ++end;
    out.push_back(rows[begin]);
    out.push_back(end - begin);
    begin = end;
  }
  return out;
}

Flags flags_from(const json& j, const Scene& scene, std::uint8_t most, std::span<const GoneRows> gone) {
  if (j.is_null()) return nullptr;
  std::vector<std::uint8_t> rows;
  std::size_t all = scene.file_rows;
  for (const GoneRows& g : gone) all += g.count;
  rows.reserve(all);
  for (std::size_t i = 0; i + 1 < j.size(); i += 2) {
    const auto value = j.at(i).get<unsigned>();
    const auto run = j.at(i + 1).get<std::size_t>();
    if (value > most || run > all - rows.size())
      throw Error("labels", fmt::format("run {} does not fit the scene's {} rows", i / 2, all));
    rows.insert(rows.end(), run, static_cast<std::uint8_t>(value));
  }
  if (rows.size() != all) throw Error("labels", fmt::format("cover {} of {} rows", rows.size(), all));
  for (auto g = gone.rbegin(); g != gone.rend(); ++g) {
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(g->first);
    rows.erase(first, first + static_cast<std::ptrdiff_t>(g->count));
  }
  std::vector<std::uint8_t> flags(scene.cloud.size());
  for (std::size_t g = 0; g < flags.size(); ++g) flags[g] = rows[scene.cloud.file_row[g]];
  return make_flags(std::move(flags));
}

namespace {

constexpr std::uint8_t kOut = 1, kIn = 2;

json doubt_json(const OpenDoubt& doubt, const Scene& scene) {
  std::vector<std::uint8_t> flags(scene.cloud.size(), 0);
  for (const std::uint32_t g : doubt.out) flags[g] = kOut;
  for (const std::uint32_t g : doubt.in) flags[g] = kIn;
  return {{"is_border", doubt.is_border}, {"gaussians", runs_json(make_flags(std::move(flags)), scene)}};
}

OpenDoubt doubt_from(const json& j, const Scene& scene) {
  OpenDoubt doubt;
  doubt.is_border = j.at("is_border");
  const Flags flags = flags_from(j.at("gaussians"), scene, kIn);
  for (std::uint32_t g = 0; flags && g < flags->size(); ++g)
    if ((*flags)[g]) ((*flags)[g] == kOut ? doubt.out : doubt.in).push_back(g);
  return doubt;
}

}  // namespace

json sides_json(std::span<const DoubtfulSide> sides, const Scene& scene) {
  json out = json::array();
  for (const DoubtfulSide& side : sides) {
    json open = json::array();
    for (const auto& doubt : side.open) open.push_back(doubt_json(*doubt, scene));
    out.push_back({{"object", side.object},
                   {"camera", camera_json(side.camera)},
                   {"looked_at", side.looked_at},
                   {"open", std::move(open)}});
  }
  return out;
}

std::vector<DoubtfulSide> sides_from(const json& j, const Scene& scene) {
  constexpr std::size_t kMostSides = 64 * kMostObjects, kMostNoted = std::size_t{1} << 26;
  std::vector<DoubtfulSide> sides;
  std::size_t noted = 0;  // a short text may name all Gaussians many times
  if (j.size() > kMostSides) throw Error("sides", fmt::format("there are {}", j.size()));
  for (const json& said : j) {
    DoubtfulSide side{said.at("object"), camera_from(said.at("camera")), said.at("looked_at")};
    for (const json& open : said.at("open")) {
      side.open.push_back(std::make_shared<const OpenDoubt>(doubt_from(open, scene)));
      noted += side.open.back()->out.size() + side.open.back()->in.size();
      if (noted > kMostNoted) throw Error("sides", "name more Gaussians than any have");
    }
    sides.push_back(std::move(side));
  }
  return sides;
}

}  // namespace splatcut
