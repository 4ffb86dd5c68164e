#include "app/studio/work_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/console/seeds_file.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

using nlohmann::json;

// 1 stored left-out views by number; 2 lacked the choice and the Gaussians displayed at a stroke; 3 knew one
// file only, and is still written where there is one.
constexpr int kVersion = 4, kVersionOfOneFile = 3;

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
    out.push_back({{"label", s.label == SeedLabel::kObject ? "object" : "rest"},
                   {"radius_px", s.radius_px},
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

Flags flags_from(const json& j, const Scene& scene, std::uint8_t most) {
  if (j.is_null()) return nullptr;
  std::vector<std::uint8_t> rows;
  rows.reserve(scene.file_rows);
  for (std::size_t i = 0; i + 1 < j.size(); i += 2) {
    const auto value = j.at(i).get<unsigned>();
    const auto run = j.at(i + 1).get<std::size_t>();
    if (value > most || run > scene.file_rows - rows.size())
      throw Error("labels", fmt::format("run {} does not fit the scene's {} rows", i / 2, scene.file_rows));
    rows.insert(rows.end(), run, static_cast<std::uint8_t>(value));
  }
  if (rows.size() != scene.file_rows)
    throw Error("labels", fmt::format("cover {} of {} rows", rows.size(), scene.file_rows));
  std::vector<std::uint8_t> flags(scene.cloud.size());
  for (std::size_t g = 0; g < flags.size(); ++g) flags[g] = rows[scene.cloud.file_row[g]];
  return make_flags(std::move(flags));
}

json object_json(const Document& document, const ObjectItem& o, const Scene& scene) {
  json views = json::array();
  for (const StrokedView& view : o.views)
    views.push_back({{"camera", camera_json(view.camera)},
                     {"strokes", strokes_json(view.strokes)},
                     {"seen", runs_json(view.seen, scene)}});
  json left_out = json::array();
  for (const Camera& camera : o.left_out) left_out.push_back(camera_json(camera));
  json out = {{"id", o.id},
              {"name", o.name},
              {"colour", {o.colour[0], o.colour[1], o.colour[2]}},
              {"visible", o.visible},
              {"locked", o.locked},
              {"within", o.within},
              {"views", views},
              {"choice", o.choice},
              {"part_step", o.part_step},
              {"left_out", left_out},
              {"cut", runs_json(o.cut, scene)},
              {"cut_is_current", o.cut != nullptr && !is_stale(document, o)},
              {"hand", runs_json(o.hand, scene)}};
  if (o.smoothness) out["smoothness"] = *o.smoothness;
  if (o.up_world) out["up"] = list(*o.up_world);
  if (o.cut_kept) out["cut_is_kept"] = true;
  return out;
}

ObjectItem object_from(const json& j, const Scene& scene) {
  ObjectItem o;
  o.id = j.at("id");
  o.name = j.at("name");
  for (std::size_t c = 0; c < 3; ++c) o.colour[c] = j.at("colour").at(c);
  o.visible = j.value("visible", true);
  o.locked = j.value("locked", false);
  o.within = j.value("within", 0u);
  if (o.within >= o.id) throw Error("object", "\"" + o.name + "\" cannot be a part of a later one");
  for (const json& view : j.at("views"))
    o.views.push_back({camera_from(view.at("camera")), strokes_from(view.at("strokes")),
                       flags_from(view.value("seen", json()), scene, 1)});
  o.choice = j.value("choice", 0);
  o.part_step = j.value("part_step", 0);
  for (const json& camera : j.value("left_out", json::array()))
    if (camera.is_object()) o.left_out.push_back(camera_from(camera));
  if (j.contains("up")) o.up_world = direction_from(j.at("up"));
  if (j.contains("smoothness")) o.smoothness = j.at("smoothness").get<float>();
  o.cut = flags_from(j.value("cut", json()), scene, 1);
  o.cut_kept = o.cut && j.value("cut_is_kept", false);
  o.hand = flags_from(j.value("hand", json()), scene, kHandRest);
  return o;
}

json parse(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw Error(path.string(), "is no file, or is not there");
  json work = json_of_file(path);
  if (!work.is_object() || !work.contains("splatcut_work"))
    throw Error(path.string(), "is no work file of splatcut");
  const json& version = work["splatcut_work"];
  if (!version.is_number_integer() || version < 1)
    throw Error(path.string(),
                fmt::format("its version {} is none that a splatcut writes", json_text(version)));
  if (version > kVersion) throw Error(path.string(), "was written by a newer splatcut", "Update splatcut");
  return work;
}

// A file beside or below the work file moves with it.
json source_json(const SceneSource& file, const std::filesystem::path& work) {
  const std::filesystem::path absolute = std::filesystem::absolute(file.path).lexically_normal();
  const std::filesystem::path relative =
      absolute.lexically_relative(std::filesystem::absolute(work).parent_path().lexically_normal());
  const bool beside = !relative.empty() && !relative.string().starts_with("..");
  const std::string place = (beside ? relative : absolute).string();
  json source = {{"path", place}, {"hash", fmt::format("{:016x}", file.hash)}, {"gaussians", file.gaussians}};
  if (!is_utf8(place)) source["path_bytes"] = std::vector<std::uint8_t>(place.begin(), place.end());
  if (file.spz_axes) source["spz_axes"] = name_of(*file.spz_axes);
  if (file.place != ScenePlace{})
    source["place"] = {{"move", list(file.place.move)},
                       {"turn_deg", list(file.place.turn_deg)},
                       {"scale", file.place.scale}};
  return source;
}

SceneSource source_from(const json& said, const std::filesystem::path& work) {
  SceneSource file;
  file.path = said.at("path").get<std::string>();
  if (said.contains("path_bytes")) {
    const auto bytes = said.at("path_bytes").get<std::vector<std::uint8_t>>();
    file.path = std::string(bytes.begin(), bytes.end());
  }
  if (!file.path.is_absolute()) file.path = std::filesystem::absolute(work).parent_path() / file.path;
  const std::string hash = said.at("hash");
  if (std::from_chars(hash.data(), hash.data() + hash.size(), file.hash, 16).ec != std::errc())
    throw Error(work.string(), "does not say which scene it belongs to: its \"hash\" is no number");
  file.spz_axes = spz_axes_from_name(said.value("spz_axes", ""));
  if (!said.contains("place")) return file;
  const json& place = said["place"];
  file.place = {vec3_from(place.at("move")), vec3_from(place.at("turn_deg")), place.at("scale").get<float>()};
  check(file.place, file.path);
  return file;
}

}  // namespace

bool is_work_file(const std::filesystem::path& path) {
  return path.string().ends_with(".splatcut.json");
}

WorkFile read_work_file(const std::filesystem::path& path) {
  try {
    json work = parse(path);
    WorkFile out;
    out.path = path;
    out.files.push_back(source_from(work.at("scene"), path));
    for (const json& added : work.value("added", json::array()))
      out.files.push_back(source_from(added, path));
    out.content = std::make_shared<const json>(std::move(work));
    return out;
  } catch (const json::exception& error) {
    throw Error(path.string(), "does not have the expected form (" + fault_of(error) + ")");
  }
}

RestoredWork restored(const WorkFile& file, const OpenedScene& opened) {
  if (file.files.size() != opened.files.size())
    throw Error(file.path.string(), "belongs to a scene of other files");
  for (std::size_t i = 0; i < file.files.size(); ++i)
    if (file.files[i].hash != opened.files[i].hash)
      throw Error(file.path.string(),
                  fmt::format("belongs to another version of {}", file.files[i].path.filename().string()),
                  "Its labels would be wrong; open the scene itself to start anew");
  const Scene& scene = *opened.scene;
  try {
    const json& work = *file.content;
    RestoredWork out;
    Document& d = out.document;
    d.active = work.value("active", 0u);
    d.next_id = work.at("next_id");
    d.up_world = direction_from(work.at("up"));
    d.preset = work.at("preset");
    preset(d.preset);  // throws for an unknown one
    d.background = vec3_from(work.at("background"));
    if (work.contains("view")) out.view = pose_from(work.at("view"));
    d.deleted = flags_from(work.value("deleted", json()), scene, 1);
    if (work.at("objects").size() > kMostObjects)
      throw Error("objects", fmt::format("there are {}, more than {}", work["objects"].size(), kMostObjects));
    for (const json& o : work.at("objects")) d.objects.push_back(object_from(o, scene));
    for (std::size_t i = 0; i < d.objects.size(); ++i) {
      ObjectItem& o = d.objects[i];
      if (o.id == 0 || o.id >= d.next_id || d.find(o.id) != &o)
        throw Error("objects", fmt::format("the id {} is used twice or out of range", o.id));
      const json& said = work.at("objects").at(i);
      const bool forgotten = said.value("left_out", json::array()).size() != o.left_out.size();
      if (forgotten)
        out.warning = "which views were left out of " + o.name +
                      " is not known any more: the file is of an older splatcut. Leave them out again";
      if (o.cut && !forgotten && said.value("cut_is_current", false)) o.cut_key = cut_key(d, o);
    }
    return out;
  } catch (const Error& error) {
    throw Error(file.path.string(), error.unstopped());
  } catch (const json::exception& error) {
    throw Error(file.path.string(), "does not have the expected form (" + fault_of(error) + ")");
  }
}

void write_work_file(const std::filesystem::path& path, const OpenedScene& opened, const Document& document,
                     const std::optional<CameraPose>& view) {
  const Scene& scene = *opened.scene;
  const std::span<const SceneSource> files = opened.files;
  json objects = json::array(), added = json::array();
  for (const ObjectItem& o : document.objects) objects.push_back(object_json(document, o, scene));
  for (const SceneSource& file : files.subspan(1)) added.push_back(source_json(file, path));
  json work = {{"splatcut_work", added.empty() ? kVersionOfOneFile : kVersion},
               {"scene", source_json(files.front(), path)},
               {"active", document.active},
               {"next_id", document.next_id},
               {"up", list(document.up_world)},
               {"preset", document.preset},
               {"background", list(document.background)},
               {"deleted", runs_json(document.deleted, scene)},
               {"objects", objects}};
  if (!added.empty()) work["added"] = added;
  if (view) work["view"] = pose_json(*view);
  write_text_file(path, json_text(work) + "\n");
}

}  // namespace splatcut
