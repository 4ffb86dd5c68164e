// The part of a scene around a place, prepared for clicks on what is there: no more is modelled than a click
// needs.
//
// In: a scene and a place. Out: the Gaussians of a cube about it, and what PreparedScene holds of them. Cubes
// are cells: a cell of level l has a side of 2^l scene units and its centre on a grid of a quarter of a side,
// so that what is clicked nearby shares one, and a thing half as large as the nearest cell keeps an eighth of
// a side away from its faces. Views that observe the Gaussians stand around the place: given cameras that
// show it, else a ring that starts on the side from which it was clicked, half as far again as the click; and
// the click's own. A close-up (usual_picture.h) is looked at with what lies around its picture, and by a ring
// half as far again as usual. A neighbourhood depends on the scene and the place alone. Cost: some 8 us a
// Gaussian in the cell (graph, parts and 12 to 25 small views), whatever the size of the scene; 600 bytes a
// Gaussian.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/job.h"
#include "scene/cloud/cloud_blocks.h"
#include "segment/superpoints/prepared_scene.h"
#include "segment/superpoints/usual_picture.h"

namespace splatcut {

struct Cell {
  int level = 0;
  int x = 0, y = 0, z = 0;  // of the centre, in quarters of a side

  float side() const;  // scene units
  glm::vec3 centre_world() const;
  Box box_world() const;
  auto operator<=>(const Cell&) const = default;
};

// The cell of that level whose centre is nearest.
Cell cell_around(const glm::vec3& point_world, int level);
// The level whose side is nearest to that length as a ratio, and the lowest whose side is as long. length:
// scene units, > 0.
int nearest_level(float length);
int level_above(float length);

struct Place {
  Cell cell;           // whose Gaussians are prepared
  Cell looked_at;      // what observing views look at
  Camera eye;          // the first of them: from where the place was clicked
  float closer = 1;    // times as close as usual the eye is where its picture is a close-up, else 1
  bool whole = false;  // all Gaussians of the scene, whatever the cell
  bool operator==(const Place& other) const;
};

// What neighbourhoods are made from. All of it outlives them but the capture.
struct WholeScene {
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<const CloudBlocks> blocks;  // of the cloud
  glm::vec3 up_world{0, -1, 0};
  Capture capture;
};

struct Neighbourhood {
  Place place;
  std::vector<std::uint32_t> row;  // of each Gaussian in the scene's cloud, ascending; empty: it is the scene
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<const PreparedScene> prepared;  // of `cloud`

  std::size_t bytes() const;  // estimated
};

// options: null where no parts are asked for. Cancelled: must not be used.
Neighbourhood prepare_neighbourhood(const WholeScene& scene, const Place& place,
                                    const PrepareOptions* options, const Job& job = {});

// Views that observe a place: its own, then given cameras that show it or a ring.
std::vector<Camera> views_around(const WholeScene& scene, const Place& place,
                                 const ObservingOptions& options);

// True where more than one percent of the labelled Gaussians lie within a sixteenth of a side of a face of
// the cell beyond which the scene goes on: then what is labelled may go on there, too. labels: of the
// neighbourhood's Gaussians.
bool touches_side(const WholeScene& scene, const Neighbourhood& near, std::span<const std::uint8_t> labels);

// Per Gaussian of the scene the value of a neighbourhood's, 0 elsewhere; and the other way round.
template <class T>
std::vector<T> in_scene(const Neighbourhood& near, std::size_t gaussians, std::vector<T> local) {
  if (near.row.empty() || local.empty()) return local;
  std::vector<T> all(gaussians, T{});
  for (std::size_t i = 0; i < near.row.size(); ++i) all[near.row[i]] = local[i];
  return all;
}
template <class T>
std::vector<T> in_neighbourhood(const Neighbourhood& near, const std::vector<T>& all) {
  if (near.row.empty() || all.empty()) return all;
  std::vector<T> local(near.row.size());
  for (std::size_t i = 0; i < local.size(); ++i) local[i] = all[near.row[i]];
  return local;
}

}  // namespace splatcut
