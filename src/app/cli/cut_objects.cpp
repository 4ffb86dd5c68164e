#include "app/cli/cut_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/console/seeds_file.h"
#include "app/document/export_plan.h"
#include "core/error.h"
#include "scene/camera/camera_names.h"
#include "segment/session/doubts.h"

namespace splatcut {

namespace {

using nlohmann::json;

std::string name_of(const json& entry, const std::string& where) {
  for (const char* key : {"name", "object"})
    if (entry.contains(key) && entry.at(key).is_string() && !entry.at(key).get<std::string>().empty())
      return entry.at(key);
  throw Error(where, "has no name", "Give \"name\": its files are called after it");
}

// Names that become the same file, or that of the rest or of all objects together.
void check_names(const std::vector<NamedSeeds>& objects, const std::string& where) {
  std::vector<std::string> taken = {"rest", "objects"};
  for (const NamedSeeds& object : objects) {
    const std::string file = file_name_of(object.name) + ".ply";
    if (std::ranges::find(taken, file_name_of(object.name)) != taken.end())
      throw Error(where,
                  fmt::format("the object \"{}\" would be written to {}, which is taken", object.name, file),
                  "Give it another name");
    taken.push_back(file_name_of(object.name));
  }
}

Error not_found(const CutObject& object) {
  if (object.name.empty()) return {"splatcut cut", "no object was found: " + object.result.reason};
  return {fmt::format("object \"{}\"", object.name), "was not found: " + object.result.reason};
}

// What more than one object claims becomes the last one's.
std::vector<std::uint8_t> settle_claims(std::vector<CutObject>* objects, std::size_t gaussians) {
  std::vector<std::uint8_t> owner(gaussians, 0);
  for (std::size_t o = 0; o < objects->size(); ++o)
    for (std::size_t g = 0; g < gaussians; ++g)
      if ((*objects)[o].result.labels[g]) owner[g] = static_cast<std::uint8_t>(o + 1);
  for (std::size_t o = 0; o < objects->size(); ++o) {
    std::vector<std::uint8_t>& labels = (*objects)[o].result.labels;
    (*objects)[o].found = static_cast<std::size_t>(std::ranges::count(labels, 1));
    for (std::size_t g = 0; g < gaussians; ++g) labels[g] = owner[g] == o + 1;
    if (objects->size() > 1 && std::ranges::count(labels, 1) == 0)
      throw Error(fmt::format("object \"{}\"", (*objects)[o].name),
                  "all of its Gaussians belong to objects after it", "List the smaller object last");
  }
  return owner;
}

// Throws Error for strokes outside of the camera's picture.
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

}  // namespace

std::optional<std::string> camera_from_json(const json& seeds, const std::string& where) {
  if (!seeds.is_object() || !seeds.contains("camera")) return std::nullopt;
  const json& camera = seeds.at("camera");
  if (camera.is_string()) return camera.get<std::string>();
  if (camera.is_number_unsigned()) return std::to_string(camera.get<unsigned long>());
  throw Error(where, "\"camera\" is neither a name nor a number");
}

Camera camera_of_seeds(const std::string& camera, const std::string& whose, const ChosenCamera& chosen,
                       const CameraOptions& options) {
  if (chosen.given.empty())
    throw Error(whose, fmt::format("its camera \"{}\" is not known", camera),
                "Give the capture's cameras with --cameras");
  const Camera found = find_camera(chosen.given, camera, options.cameras.string());
  return options.size.empty() ? found : resized(found, chosen.camera.width_px, chosen.camera.height_px);
}

std::vector<NamedSeeds> named_seeds_from_json(const json& seeds, const std::string& where) {
  if (!seeds.is_object() || !seeds.contains("objects")) return {};
  const json& list = seeds.at("objects");
  if (!list.is_array() || list.empty() || list.size() > kMostObjects)
    throw Error(where, fmt::format("\"objects\" is not a list of 1 to {} objects", kMostObjects));
  if (seeds.contains("choice"))
    throw Error(where, "\"choice\" stands beside \"objects\"", "Put it into one of the objects");
  const std::optional<std::string> of_all = camera_from_json(seeds, where);
  std::vector<NamedSeeds> objects;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string entry = fmt::format("{}: object {}", where, i);
    if (!list[i].is_object()) throw Error(entry, "is not an object with \"name\" and \"clicks\"");
    refuse_unknown_seeds(list[i], entry, true);
    const std::optional<std::string> own = camera_from_json(list[i], entry);
    objects.push_back({name_of(list[i], entry), own ? own : of_all, strokes_from_json(list[i], entry),
                       choice_from_json(list[i], entry)});
    if (objects.back().strokes.empty()) throw Error(entry, "holds neither clicks nor boxes nor scribbles");
  }
  check_names(objects, where);
  return objects;
}

std::vector<std::string> CutObject::doubts() const {
  std::vector<std::string> sentences = splatcut::doubts(result);
  if (!doubt_of_mask.empty()) sentences.insert(sentences.begin(), doubt_of_mask);
  return sentences;
}

std::vector<CutObject> objects_of(const std::vector<NamedSeeds>& seeds, const ChosenCamera& chosen,
                                  const CameraOptions& camera) {
  std::vector<CutObject> objects;
  for (const NamedSeeds& object : seeds) {
    const Camera seen_from =
        object.camera
            ? camera_of_seeds(*object.camera, fmt::format("object \"{}\"", object.name), chosen, camera)
            : chosen.camera;
    CutRequest request;
    request.strokes = {{seen_from, object.strokes}};
    request.choice = object.choice;
    objects.push_back({object.name, std::move(request), seen_from, {}});
  }
  return objects;
}

std::string fewer_meanings(const CutResult& result, int asked) {
  if (result.choice >= static_cast<std::size_t>(asked)) return {};
  return fmt::format(
      "what was said first can mean {} only: this is {}, not {}",
      result.meanings.size() <= 1 ? "one thing" : fmt::format("{} things", result.meanings.size()),
      result.choice + 1, asked + 1);
}

void check_inside(const CutRequest& request) {
  for (const StrokedView& view : request.strokes) check_inside(view.strokes, view.camera);
}

std::vector<std::uint8_t> cut_objects(std::vector<CutObject>* objects, Session* session,
                                      const CutSettings& settings, const Job& job) {
  std::size_t gaussians = 0;
  for (CutObject& object : *objects) {
    object.result = session->cut(object.request, settings, job);
    if (job.cancelled()) return {};
    if (object.result.outcome == Outcome::kNothingFound) throw not_found(object);
    gaussians = object.result.labels.size();
  }
  return settle_claims(objects, gaussians);
}

}  // namespace splatcut
