#include "app/cli/cutout_files.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/console/labels_file.h"
#include "app/document/export_plan.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/png_file.h"
#include "core/stage_clock.h"
#include "scene/cloud/convex_hull.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

// The mask in warm orange over the dimmed picture, with a bright outline.
void tint(const Mask& mask, Image<Rgb8>* picture) {
  const Mask core = eroded(mask, 1);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    Rgb8& p = picture->pixels()[i];
    const Rgb8 orange{255, 140, 30};
    const int share = !mask.pixels()[i] ? 0 : core.pixels()[i] ? 90 : 230;  // of 256
    for (int c = 0; c < 3; ++c)
      p[c] =
          static_cast<std::uint8_t>(share ? (p[c] * (256 - share) + orange[c] * share) >> 8 : p[c] * 3 / 5);
  }
}

Image<Rgb8> tinted_by_mask(const Drawer& scene, const Camera& camera, const Mask& mask) {
  Image<Rgb8> picture = rgb8_from_linear(scene.draw(camera, {}).colour);
  tint(mask, &picture);
  return picture;
}

Image<Rgb8> contact_sheet(const Drawer& scene, const std::vector<ViewReport>& views) {
  constexpr int kGap = 4;
  const int columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(views.size())))));
  const Camera& first = views.front().camera;
  const int width = first.width_px, height = first.height_px;
  const int rows = (static_cast<int>(views.size()) + columns - 1) / columns;
  Image<Rgb8> sheet(columns * (width + kGap) - kGap, rows * (height + kGap) - kGap, Rgb8{24, 24, 24});
  for (std::size_t v = 0; v < views.size(); ++v) {
    const ViewReport& view = views[v];
    const Image<Rgb8> picture = tinted_by_mask(scene, view.camera, view.mask);
    const int x0 = static_cast<int>(v) % columns * (width + kGap),
              y0 = static_cast<int>(v) / columns * (height + kGap);
    for (int y = 0; y < std::min(height, picture.height()); ++y)
      for (int x = 0; x < std::min(width, picture.width()); ++x) {
        Rgb8 p = picture.at(x, y);
        if (!view.used)
          p = {static_cast<std::uint8_t>(p[0] / 3), static_cast<std::uint8_t>(p[1] / 3),
               static_cast<std::uint8_t>(p[2] / 3)};
        sheet.at(x0 + x, y0 + y) = p;
      }
  }
  return sheet;
}

// Beside the object's .ply: in the same place.
void write_hull(const CutoutFolder& to, const std::string& file, const GaussianCloud& cloud,
                std::span<const std::uint8_t> keep) {
  ConvexHull hull = convex_hull(cloud, keep);
  if (to.to)
    for (glm::vec3& corner : hull.corners) corner = moved(corner, to.to->by);
  const bool adds_origin = !to.to || to.to->adds_origin;
  write_text_file(to.folder.file(file), obj_text(hull, adds_origin ? to.scene.origin : glm::dvec3(0)));
}

// From which sides the object was seen, and by which views where a picture of that is written.
void look_from_all_sides(const CutoutFolder& to, const ObjectFiles& files,
                         const std::vector<std::uint8_t>& labels, const ObjectView* shown,
                         EdgesReport* report, const Job& job) {
  if (std::ranges::count(labels, 1) == 0) return;
  const auto start = std::chrono::steady_clock::now();
  const glm::vec3 from = shown                ? shown->camera.centre_world()
                         : to.cameras.empty() ? object_extent(to.scene.cloud, labels).centre_world
                                              : to.cameras.front().centre_world();
  const bool picture = shown && to.options.writes("seen");
  report->seen = (picture ? seen_from : seen_sides)(to.drawer(), labels, to.up_world, from, to.cameras, job);
  if (picture && !job.cancelled()) {
    write_png(to.folder.file(files.seen), seen_picture(*report->seen, to.drawer(), labels, job));
    report->ground = unseen_ground(to.drawer(), labels, to.up_world, to.cameras, job);
  }
  report->seen_ms = ms_since(start);
}

// What fills the holes of all objects.
RestChanges fill_of(std::span<const EdgesReport> objects) {
  RestChanges filled;
  for (const EdgesReport& object : objects)
    if (object.fill) add(object.fill->changes, &filled);
  return filled;
}

// What was invented comes last. What is not given back is told in the reports.
RestChanges changes_of(const CutoutFolder& to, const RestChanges& filled, std::span<EdgesReport> objects) {
  RestChanges all;
  for (EdgesReport& object : objects) {
    if (!object.rest) continue;
    object.not_given_back = spare_copy(to.scene, SceneFormat::kPly, to.to.has_value(), filled, &*object.rest);
    add(*object.rest, &all);
  }
  add(filled, &all);
  return all;
}

// What leaves the rest beside the object and its ghosts, and no longer tells of the surface below it.
std::vector<std::uint32_t> gone_with(const CutoutFolder& to, const std::vector<std::uint8_t>& labels,
                                     const std::optional<RestChanges>& rest) {
  std::vector<std::uint32_t> gone = rest ? rest->ghosts : std::vector<std::uint32_t>();
  for (std::uint32_t g = 0; g < to.owner.size(); ++g)
    if (to.owner[g] && !labels[g]) gone.push_back(g);
  return gone;
}

nlohmann::json seen_json(const SeenFrom& seen) {
  nlohmann::json result = {{"never_from", seen.never()}, {"unseen_share", seen.unseen_share()}};
  if (!seen.views.empty())
    result.update({{"views", seen.views.size()}, {"unseen", std::ranges::count(seen.by_views, 0)}});
  for (std::size_t s = seen.has_front ? 0 : kLevelSides; s < kSideNames.size(); ++s)
    result["sides"][kSideNames.at(s)] = seen.side_share.at(s);
  return result;
}

}  // namespace

nlohmann::json fill_json(const SurfacePatch& patch) {
  if (!patch.why_not.empty()) return {{"filled", false}, {"why_not", patch.why_not}};
  return {{"filled", true},         {"invented", patch.changes.given_back.size()},
          {"pieces", patch.pieces}, {"replaced", patch.changes.ghosts.size()},
          {"area", patch.area},     {"rim_error", patch.rim_error}};
}

nlohmann::json clean_json(const std::optional<CleanReport>& clean) {
  nlohmann::json json = {{"edges", clean && clean->cleaned ? "clean" : "keep"}};
  if (!clean) return json;
  json.update({{"views", clean->views}, {"agreed", clean->agreed}});
  if (!clean->cleaned) {
    json["why_kept"] = clean->why_not;
    return json;
  }
  json["used"] = clean->used;
  json.update({{"left", clean->left},
               {"split", clean->split},
               {"made_solid", clean->made_solid},
               {"recoloured", clean->recoloured}});
  return json;
}

void CutoutOptions::add_to(CLI::App& command) {
  command
      .add_option("--edges", edges,
                  "clean: the object without what the scene around it had hidden; keep: its rows as they are")
      ->check(CLI::IsMember({"clean", "keep"}))
      ->capture_default_str();
  command
      .add_option(
          "--fill", fill,
          "surface: the hole that the object leaves in a flat surface is filled with a copy of the surface "
          "beside it, in rest.ply; none: it stays")
      ->check(CLI::IsMember({"none", "surface"}))
      ->capture_default_str();
  command
      .add_option("--write", write,
                  "Which files: object, rest, labels, pictures, npy (labels.npy for numpy), objects (all in "
                  "objects.ply, numbered as object_id), hull (convex, of each object, as .obj), seen (from "
                  "which sides each was, as a picture), fill (what fills holes in the rest, alone); "
                  "several with commas. Without it: the first four")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(
          CLI::IsMember({"object", "rest", "labels", "pictures", "npy", "objects", "hull", "seen", "fill"}));
  command
      .add_option("--origin", origin,
                  "What becomes 0, 0, 0 of the written Gaussians: scene (as it is), centre or foot of the "
                  "object, or of all objects together")
      ->check(CLI::IsMember(std::vector<std::string>(kOriginNames.begin(), kOriginNames.end())))
      ->capture_default_str();
  command.add_option("--up", up, "Where up points in the written files: scene (as it is), +y, -y or +z")
      ->check(CLI::IsMember(std::vector<std::string>(kUpNames.begin(), kUpNames.end())))
      ->capture_default_str();
  command.add_option("--scale-by", known_length,
                     "x0,y0,x1,y1,metres: the written Gaussians in metres, by what lies between the surface "
                     "at two pixels of the reference view");
}

bool CutoutOptions::writes(std::string_view what) const {
  return std::ranges::find(write, what) != write.end();
}

void CutoutOptions::check() const {
  if (fill == "surface" && !writes("rest"))
    throw Error("--fill surface", "fills the hole in rest.ply, which is not written",
                "Add rest to --write, or leave --fill out");
  if (writes("fill") && fill != "surface")
    throw Error("--write fill", "writes what fills a hole, and none is filled", "Add --fill surface");
  constexpr std::array kPlaced = {"object", "rest", "objects", "hull", "fill"};
  if (std::ranges::any_of(kPlaced, [&](const char* file) { return writes(file); })) return;
  const char* const placing = origin != "scene"       ? "--origin"
                              : up != "scene"         ? "--up"
                              : !known_length.empty() ? "--scale-by"
                                                      : nullptr;
  if (placing)
    throw Error(placing, "places written Gaussians, and --write names no file that holds some",
                "Add object to --write, or leave it out");
}

std::string EdgesReport::sentence() const {
  return clean && !clean->cleaned ? "edges are kept: " + clean->why_not : "";
}

nlohmann::json EdgesReport::json(bool times) const {
  nlohmann::json json = clean_json(clean);
  json["gaussians"] = gaussians;
  if (fill) json["fill"] = fill_json(*fill);
  if (seen) json["seen"] = seen_json(*seen);
  if (ground && ground->why_not.empty()) json["seen"]["ground_area"] = ground->area;
  if (ground && !ground->why_not.empty()) json["seen"]["no_ground"] = ground->why_not;
  if (!clean) return json;
  if (times) json["ms"] = ms;
  if (!clean->cleaned) return json;
  if (rest) json.update({{"ghosts", rest->ghosts.size()}, {"given_back", rest->given_back.size()}});
  if (not_given_back > 0) json["not_given_back"] = not_given_back;
  return json;
}

ObjectFiles files_of_object(const std::string& name) {
  return {name + ".ply",      name + ".hull.obj",  name + ".labels.u8", name + ".png",
          name + ".tint.png", name + ".masks.png", name + ".seen.png"};
}

ObjectFiles files_of_only_object() {
  return {"object.ply", "object.hull.obj", "", "object.png", "tint.png", "masks.png", "seen.png"};
}

Image<Rgba8> cutout_picture(const Drawer& scene, const Camera& camera, std::span<const std::uint8_t> shown) {
  RasterOptions options;
  options.shown = shown;
  const RasterOutput out = scene.draw(camera, options);
  return rgba8_from_premultiplied(out.colour, out.alpha);
}

Image<Rgb8> tinted_picture(const Drawer& scene, const Camera& camera,
                           const std::vector<std::uint8_t>& labels) {
  return tinted_by_mask(scene, camera, thresholded(render_labels(scene, camera, labels), 0.5f));
}

EdgesReport write_object(const CutoutFolder& to, const ObjectFiles& files,
                         const std::vector<std::uint8_t>& labels, const ObjectView* shown, const Job& job) {
  const bool scene = to.options.writes("object"), hull = to.options.writes("hull"),
             pictures = shown && to.options.writes("pictures");
  EdgesReport report;
  report.gaussians = static_cast<std::size_t>(std::ranges::count(labels, 1));
  std::optional<CleanObject> clean;
  if (to.options.clean() && (scene || hull || pictures || to.rest)) {
    const auto start = std::chrono::steady_clock::now();
    clean = clean_object({to.drawer(), labels, to.up_world, to.cameras, to.rest, to.owner}, {}, job);
    report.ms = ms_since(start);
    report.clean = clean->report;
    if (to.rest) report.rest = std::move(clean->rest);
    if (!clean->report.cleaned) clean.reset();
  }
  if (to.rest && to.options.fill == "surface")
    report.fill =
        fill_surface(to.drawer(), labels, gone_with(to, labels, report.rest), to.up_world, to.cameras, job);
  if (job.cancelled()) return report;
  if (scene) {
    SaveReport saved =
        save_gaussians(to.folder.file(files.scene), to.scene, labels, clean ? &clean->cloud : nullptr,
                       SceneFormat::kPly, to.to, {.up = to.up});
    report.gaussians = saved.gaussians;
    report.lost = std::move(saved.loss);
  }
  if (hull)
    write_hull(to, files.hull, clean ? clean->cloud : to.scene.cloud,
               clean ? std::span<const std::uint8_t>() : labels);
  look_from_all_sides(to, files, labels, shown, &report, job);
  if (job.cancelled()) return report;
  if (!files.labels.empty() && to.options.writes("labels"))
    write_labels(to.folder.file(files.labels), to.scene, labels);
  if (!pictures) return report;
  write_png(to.folder.file(files.picture),
            cutout_picture(clean ? Drawer(clean->cloud) : to.drawer(), shown->camera,
                           clean ? std::span<const std::uint8_t>() : labels));
  write_png(to.folder.file(files.tint), tinted_picture(to.drawer(), shown->camera, labels));
  write_png(to.folder.file(files.masks), contact_sheet(to.drawer(), shown->views));
  return report;
}

RestReport write_rest(const CutoutFolder& to, const std::vector<std::uint8_t>& owner,
                      std::span<EdgesReport> objects, const Camera& camera) {
  std::vector<std::uint8_t> rest(owner.size());
  std::ranges::transform(owner, rest.begin(),
                         [](std::uint8_t o) { return static_cast<std::uint8_t>(o == 0); });
  RestReport report{static_cast<std::size_t>(std::ranges::count(rest, 1)), {}};
  const auto note = [&](const std::string& file, const SaveReport& saved) {
    if (!saved.loss.empty()) report.lost[file] = saved.loss;
  };
  if (to.options.writes("rest")) {
    const RestChanges filled = fill_of(objects), changes = changes_of(to, filled, objects);
    if (to.options.writes("fill") && !filled.given_back.empty())
      save_gaussians(to.folder.file("fill.ply"), to.scene, {}, &filled.given_back, SceneFormat::kPly, to.to,
                     {.up = to.up});
    const SaveReport saved = save_rest(to.folder.file("rest.ply"), to.scene, rest, changes, SceneFormat::kPly,
                                       to.to, {.may_be_empty = true, .up = to.up});
    report.gaussians = saved.gaussians;
    note("rest.ply", saved);
    if (to.options.writes("pictures")) {
      std::vector<std::uint8_t> shown = rest;
      for (const std::uint32_t g : changes.ghosts) shown[g] = 0;
      write_png(to.folder.file("rest.png"),
                changes.given_back.empty()
                    ? cutout_picture(to.drawer(), camera, shown)
                    : cutout_picture(Drawer(rest_of(to.scene.cloud, rest, changes)), camera, {}));
    }
  }
  if (to.options.writes("labels")) write_labels(to.folder.file("labels.u8"), to.scene, owner);
  if (to.options.writes("objects"))
    note("objects.ply", save_gaussians(to.folder.file("objects.ply"), to.scene, owner, nullptr,
                                       SceneFormat::kPly, to.to, {.up = to.up, .object_ids = owner}));
  if (to.options.writes("npy")) write_labels(to.folder.file("labels.npy"), to.scene, owner);
  return report;
}

}  // namespace splatcut
