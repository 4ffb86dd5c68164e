#include "app/cli/many_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/cli/cutout_files.h"
#include "app/console/seeds_file.h"
#include "app/document/export_plan.h"
#include "core/error.h"
#include "scene/camera/camera_names.h"

namespace splatcut {

namespace {

using nlohmann::json;

std::string name_of(const json& entry, const std::string& where) {
  for (const char* key : {"name", "object"})
    if (entry.contains(key) && entry.at(key).is_string() && !entry.at(key).get<std::string>().empty())
      return entry.at(key);
  throw Error(where, "has no name", "Give \"name\": its files are called after it");
}

std::optional<std::string> camera_of(const json& entry, const std::string& where) {
  if (!entry.contains("camera")) return std::nullopt;
  const json& camera = entry.at("camera");
  if (camera.is_string()) return camera.get<std::string>();
  if (camera.is_number_unsigned()) return std::to_string(camera.get<unsigned long>());
  throw Error(where, "\"camera\" is neither a name nor a number");
}

// Names that become the same file, or that of the rest.
void check_names(const std::vector<NamedSeeds>& objects, const std::string& where) {
  std::vector<std::string> taken = {"rest"};
  for (const NamedSeeds& object : objects) {
    const std::string file = file_name_of(object.name) + ".ply";
    if (std::ranges::find(taken, file_name_of(object.name)) != taken.end())
      throw Error(where,
                  fmt::format("the object \"{}\" would be written to {}, which is taken", object.name, file),
                  "Give it another name");
    taken.push_back(file_name_of(object.name));
  }
}

// The camera that the object's strokes are seen from.
Camera camera_for(const ManyObjects& in, const NamedSeeds& object) {
  if (!object.camera) return in.chosen.camera;
  if (in.chosen.given.empty())
    throw Error(fmt::format("object \"{}\"", object.name),
                fmt::format("its camera \"{}\" is not known", *object.camera),
                "Give the capture's cameras with --cameras");
  const Camera camera = find_camera(in.chosen.given, *object.camera, in.camera.cameras.string());
  return in.camera.size.empty() ? camera
                                : resized(camera, in.chosen.camera.width_px, in.chosen.camera.height_px);
}

struct CutObject {
  const NamedSeeds* seeds;
  Camera camera;
  CutResult result;
  std::size_t found = 0;  // Gaussians, before later objects took theirs
};

// What more than one object claims becomes the last one's. Returns 0 for the rest, 1 for the first object,
// ...
std::vector<std::uint8_t> settle_claims(std::vector<CutObject>* objects, std::size_t gaussians) {
  std::vector<std::uint8_t> owner(gaussians, 0);
  for (std::size_t o = 0; o < objects->size(); ++o)
    for (std::size_t g = 0; g < gaussians; ++g)
      if ((*objects)[o].result.labels[g]) owner[g] = static_cast<std::uint8_t>(o + 1);
  for (std::size_t o = 0; o < objects->size(); ++o) {
    std::vector<std::uint8_t>& labels = (*objects)[o].result.labels;
    (*objects)[o].found = static_cast<std::size_t>(std::ranges::count(labels, 1));
    for (std::size_t g = 0; g < gaussians; ++g) labels[g] = owner[g] == o + 1;
    if (std::ranges::count(labels, 1) == 0)
      throw Error(fmt::format("object \"{}\"", (*objects)[o].seeds->name),
                  "all of its Gaussians belong to objects after it", "List the smaller object last");
  }
  return owner;
}

json entry_of(const CutObject& object, const CutoutObject& written, std::size_t index) {
  const std::string file = file_name_of(object.seeds->name);
  json entry = object_json(object.result);
  const auto gaussians = entry["object"]["gaussians"].get<std::size_t>();
  entry.erase("object");
  entry.update({{"name", object.seeds->name},
                {"index", index},
                {"file", file + ".ply"},
                {"labels", file + ".labels.u8"},
                {"camera", object.camera.name},
                {"gaussians", gaussians},
                {"left_to_later", object.found - gaussians},
                {"edges", written.report()},
                {"ambiguous", object.result.ambiguous}});
  return entry;
}

void write_object(const OutputFolder& folder, const Scene& scene, const Drawer& drawer,
                  const CutObject& object, const CutoutObject& written) {
  const std::string file = file_name_of(object.seeds->name);
  write_object_files(folder, scene, file, written, object.result.labels);
  write_object_pictures(folder, drawer, object.camera, object.result, written,
                        {file + ".png", file + ".tint.png", file + ".masks.png"});
}

}  // namespace

void check_inside(const Strokes& strokes, const Camera& camera) {
  for (const Stroke& stroke : strokes) {
    if (stroke.is_box()) {
      if (box_is_too_small(stroke, camera.width_px, camera.height_px))
        throw Error("box", fmt::format("less than 6 pixels of a side lie in the {}x{} picture",
                                       camera.width_px, camera.height_px));
      continue;
    }
    for (const glm::vec2& p : stroke.points_px)
      if (!(p.x >= 0 && p.y >= 0 && p.x < static_cast<float>(camera.width_px) &&
            p.y < static_cast<float>(camera.height_px)))
        throw Error("strokes", fmt::format("the point {},{} lies outside of the {}x{} picture", p.x, p.y,
                                           camera.width_px, camera.height_px));
  }
}

std::vector<NamedSeeds> named_seeds_from_json(const json& seeds, const std::string& where) {
  if (!seeds.is_object() || !seeds.contains("objects")) return {};
  const json& list = seeds.at("objects");
  if (!list.is_array() || list.empty() || list.size() > kMostObjects)
    throw Error(where, fmt::format("\"objects\" is not a list of 1 to {} objects", kMostObjects));
  std::vector<NamedSeeds> objects;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string entry = fmt::format("{}: object {}", where, i);
    if (!list[i].is_object()) throw Error(entry, "is not an object with \"name\" and \"clicks\"");
    objects.push_back({name_of(list[i], entry), camera_of(list[i], entry), strokes_from_json(list[i], entry),
                       choice_from_json(list[i], entry)});
    if (objects.back().strokes.empty()) throw Error(entry, "holds neither clicks nor scribbles");
  }
  check_names(objects, where);
  return objects;
}

void check_objects(const ManyObjects& in) {
  for (const NamedSeeds& seeds : in.objects) check_inside(seeds.strokes, camera_for(in, seeds));
}

json cut_many_objects(const ManyObjects& in, Session* session, const OutputFolder& folder, const Job& job) {
  const Scene& scene = in.scene;
  std::vector<CutObject> objects;
  for (const NamedSeeds& seeds : in.objects) objects.push_back({&seeds, camera_for(in, seeds), {}});
  for (CutObject& object : objects) {
    if (job.cancelled()) return {};
    CutRequest request;
    request.strokes = {{object.camera, object.seeds->strokes}};
    request.choice = object.seeds->choice;
    request.part_step = in.part_step;
    object.result = session->cut(request, in.settings, job);
    if (object.result.outcome == Outcome::kCancelled) return {};
    if (object.result.outcome == Outcome::kNothingFound)
      throw Error(fmt::format("object \"{}\"", object.seeds->name), "was not found: " + object.result.reason);
  }
  const std::vector<std::uint8_t> owner = settle_claims(&objects, scene.cloud.size());
  const Drawer drawer(scene.cloud, nullptr, &session->blocks());
  json entries = json::array();
  for (const CutObject& object : objects) {
    if (job.cancelled()) return {};
    const CutoutObject written(scene, object.result.labels, in.edges,
                               {in.chosen.up_world, in.chosen.given, session->blocks()}, job);
    if (job.cancelled()) return {};
    write_object(folder, scene, drawer, object, written);
    entries.push_back(entry_of(object, written, entries.size() + 1));
  }
  std::vector<std::uint8_t> rest(owner.size());
  std::ranges::transform(owner, rest.begin(),
                         [](std::uint8_t o) { return static_cast<std::uint8_t>(o == 0); });
  SaveOptions of_rest;
  of_rest.may_be_empty = true;
  save_scene(folder.file("rest.ply"), scene, rest, SceneFormat::kPly, of_rest);
  write_cutout_picture(folder.file("rest.png"), drawer, in.chosen.camera, rest);
  write_labels(folder.file("labels.u8"), scene, owner);
  return {{"objects", entries},
          {"rest", {{"gaussians", std::ranges::count(rest, 1)}}},
          {"stages", json::array()}};
}

}  // namespace splatcut
