// The files that `splatcut cut` writes of its objects: scenes, labels, pictures.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/console/output_folder.h"
#include "app/document/export_plan.h"
#include "core/image.h"
#include "scene/formats/scene_file.h"
#include "scene/raster/projected_view.h"
#include "segment/finish/clean.h"
#include "segment/finish/fill.h"
#include "segment/finish/seen_from.h"
#include "segment/finish/unseen_ground.h"
#include "segment/session/cut_result.h"

namespace CLI {
class App;
}

namespace splatcut {

struct CutoutOptions {
  std::string edges = "clean", fill = "none";
  std::vector<std::string> write = {"object", "rest", "labels", "pictures"};

  std::string origin = "scene", up = "scene";  // of the written Gaussians: export_placement.h
  std::string known_length;                    // "x0,y0,x1,y1,metres", or empty

  void add_to(CLI::App& command);  // which must not outlive this
  bool clean() const { return edges != "keep"; }
  bool writes(std::string_view what) const;
  // Throws Error for options that work on files which are not written.
  void check() const;
};

// What was done to the edges of an object.
struct EdgesReport {
  std::optional<CleanReport> clean;    // none: --edges keep
  std::size_t gaussians = 0;           // written
  std::optional<RestChanges> rest;     // where rest.ply is written, too
  std::optional<SurfacePatch> fill;    // where that is asked for, too
  std::optional<SeenFrom> seen;        // of an object that has Gaussians; by views where that is asked for
  std::optional<UnseenGround> ground;  // where a picture of what was seen is written
  std::size_t not_given_back = 0;      // see spare_copy()
  std::string lost;                    // what its .ply lacks of the scene's, as SaveReport says it
  double ms = 0, seen_ms = 0;          // of the cleaning; of what was seen

  std::string sentence() const;                  // what the guard said and what became of it; empty: nothing
  nlohmann::json json(bool times = true) const;  // {"edges": "clean" or "keep", ...}
};

// The scene that objects are written of, and the folder that they are written to.
struct CutoutFolder {
  const OutputFolder& folder;
  const Scene& scene;
  const CloudBlocks& blocks;  // of the scene
  glm::vec3 up_world;         // of the scene, as are the cameras of its capture
  std::span<const Camera> cameras;
  const CutoutOptions& options;
  bool rest = false;  // whether write_rest() follows and writes it
  std::span<const std::uint8_t> owner =
      {};                            // per Gaussian, not 0: it leaves the rest; empty: the object does
  std::optional<MovedTo> to = {};    // where all written Gaussians are moved to
  std::optional<glm::vec3> up = {};  // what the files say of up, before they are moved; none: nothing

  Drawer drawer() const { return {scene.cloud, nullptr, &blocks}; }
};

nlohmann::json fill_json(const SurfacePatch& patch);
nlohmann::json clean_json(const std::optional<CleanReport>& clean);  // {"edges": "clean" or "keep", ...}

// What .ply files lack of the scene's, by their names; those that lack nothing are not there.
using LostByFile = std::map<std::string, std::string>;

struct RestReport {
  std::size_t gaussians = 0;  // of the rest
  LostByFile lost;
};

// Names of an object's files; an empty one is not written.
struct ObjectFiles {
  std::string scene, hull, labels, picture, tint, masks, seen;
};
ObjectFiles files_of_object(const std::string& name);  // NAME.ply, NAME.hull.obj, NAME.png, ...
ObjectFiles files_of_only_object();                    // object.ply, object.hull.obj, object.png, ...

// How an object is shown in its pictures.
struct ObjectView {
  const Camera& camera;
  const std::vector<ViewReport>& views;  // drawn side by side
};

// What is shown of the scene on nothing. shown: per Gaussian, 1 = shown; empty: all.
Image<Rgba8> cutout_picture(const Drawer& scene, const Camera& camera, std::span<const std::uint8_t> shown);
// The object in warm orange over the dimmed scene.
Image<Rgb8> tinted_picture(const Drawer& scene, const Camera& camera,
                           const std::vector<std::uint8_t>& labels);

// labels: per Gaussian, 1 = object. shown: null where no picture is written. The scene's file holds the
// object with clean edges where these are asked for and can be had, else its rows as they are. Throws Error
// as save_scene() does. Cancelled: files are missing.
EdgesReport write_object(const CutoutFolder& to, const ObjectFiles& files,
                         const std::vector<std::uint8_t>& labels, const ObjectView* shown, const Job& job);

// Of these, what the options name: rest.ply (without Gaussians where all are an object's), rest.png from
// `camera`, labels.u8 and labels.npy (`owner` in file order), objects.ply (all objects, rows as they are,
// each with its owner as object_id). objects: what was done to them changes the rest; what is not given back
// leaves them.
RestReport write_rest(const CutoutFolder& to, const std::vector<std::uint8_t>& owner,
                      std::span<EdgesReport> objects, const Camera& camera);

}  // namespace splatcut
