#include "segment/finish/fill.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/cloud/quantise.h"
#include "segment/finish/filling.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

// Of each Gaussian that is copied, its place and its colour.
struct Copies {
  std::vector<std::uint32_t> of;
  std::vector<glm::vec3> moved_world, added_dc;

  GaussianCloud of_cloud(const GaussianCloud& cloud) const {
    GaussianCloud copies = permuted(cloud, of);
    for (std::size_t i = 0; i < of.size(); ++i) {
      copies.position[i] += moved_world[i];
      copies.f_dc[i] += added_dc[i];
    }
    return copies;
  }
};

// Whether a Gaussian of the map would reach beyond these cells, moved so.
bool reaches_beyond(const GaussianCloud& cloud, std::uint32_t g, const SurfaceMap& map,
                    const glm::ivec2& moved, const Mask& surface) {
  constexpr float kReach = 2;  // standard deviations
  const glm::vec3& scale = cloud.scale[g];
  const int longest = scale.x >= std::max(scale.y, scale.z) ? 0 : scale.y >= scale.z ? 1 : 2;
  const glm::vec3 reach = kReach * scale[longest] * glm::mat3_cast(cloud.rotation[g])[longest];
  return std::ranges::any_of(std::array{-1.0f, 1.0f}, [&](float end) {
    const std::optional<glm::ivec2> cell = map.cell(cloud.position[g] + end * reach);
    return !cell || !is_set(surface, *cell + moved);
  });
}

Copies copies_of(const Piece& piece, const Image<glm::vec3>& difference, const GaussianCloud& cloud,
                 const SurfaceMap& map, const Ground& ground, const Mask& surface) {
  constexpr float kMostAdded = 0.2f;
  Copies copies;
  for (const std::vector<std::uint32_t>* some : {&ground.layer, &ground.backing})
    for (const std::uint32_t g : *some) {
      const glm::ivec2 to = *map.cell(cloud.position[g]) - piece.moved;
      if (!is_set(piece.cells, to) || reaches_beyond(cloud, g, map, -piece.moved, surface)) continue;
      copies.of.push_back(g);
      copies.moved_world.push_back(map.world_of(-piece.moved));
      copies.added_dc.push_back(glm::clamp(difference.at(to.x, to.y), -kMostAdded, kMostAdded) /
                                kShC0Rounded);
    }
  return copies;
}

bool covers(const GaussianCloud& clones, const SurfaceMap& map, const Mask& hole, const Job& job) {
  constexpr float kCovers = 0.5f;
  constexpr double kLeastShare = 0.7;
  const Image<float> alpha = map.draw(clones, job).alpha;
  if (job.cancelled()) return false;
  double covered = 0;
  for (const glm::ivec2& c : cells_of(hole)) covered += alpha.at(c.x, c.y) > kCovers;
  return covered >= kLeastShare * static_cast<double>(count(hole));
}

template <class T>
void append(const std::vector<T>& more, std::vector<T>* to) {
  to->insert(to->end(), more.begin(), more.end());
}

void fill_hole(const Mask& hole, const GaussianCloud& cloud, const SurfaceMap& map, const Ground& ground,
               SurfacePatch* patch, const Job& job) {
  constexpr int kMostPieces = 24;
  constexpr float kMostRimError = 0.22f;
  const Mask surface = mask_of([&](auto c) { return is_set(ground.covered, c) || is_set(hole, c); });
  Filling filling(ground, hole);
  Copies copies;
  float squares = 0, rim_cells = 0;
  for (; patch->pieces < kMostPieces && !job.cancelled(); ++patch->pieces) {
    const std::optional<Piece> piece = filling.next(job);
    if (!piece) break;
    squares += piece->squares;
    rim_cells += piece->rim_cells;
    const Copies more = copies_of(*piece, filling.fill(*piece), cloud, map, ground, surface);
    append(more.of, &copies.of);
    append(more.moved_world, &copies.moved_world);
    append(more.added_dc, &copies.added_dc);
  }
  if (job.cancelled()) return;
  patch->rim_error = rim_cells > 0 ? std::sqrt(squares / rim_cells) : 0;
  if (patch->rim_error > kMostRimError) {
    patch->why_not = "nothing beside the hole looks like its rim";
    return;
  }
  patch->changes.given_back = copies.of_cloud(cloud);
  if (!covers(patch->changes.given_back, map, hole, job)) {
    patch->changes.given_back = {};
    patch->why_not = "too little of the surface beside it is free";
    return;
  }
  patch->area = static_cast<double>(count(hole)) * map.cell_area();
  for (const OutlineSide& side : outline_of(hole, map)) patch->outline_world.push_back(side.ends_world);
  for (const std::vector<std::uint32_t>* some : {&ground.layer, &ground.rubbish})
    for (const std::uint32_t g : *some)
      if (is_set(hole, *map.cell(cloud.position[g]))) patch->changes.ghosts.push_back(g);
  std::ranges::sort(patch->changes.ghosts);
}

}  // namespace

SurfacePatch fill_surface(const Drawer& scene, std::span<const std::uint8_t> labels,
                          std::span<const std::uint32_t> gone, const glm::vec3& up_world,
                          std::span<const Camera> cameras, const Job& job) {
  constexpr std::size_t kLeastCells = 12;
  SurfacePatch patch;
  std::vector<std::uint8_t> is_gone(labels.size(), 0);
  for (const std::uint32_t g : gone) is_gone[g] = 1;
  job.progress("the hole", 0);
  const std::optional<SurfaceBelow> below =
      surface_below(scene, labels, up_world, cameras, &patch.why_not, job);
  if (!below) return patch;
  constexpr float kLeastShare = 0.12f;  // less lies in any plane by chance
  if (below->share < kLeastShare) {
    patch.why_not = "what surrounds the object is uneven, or a haze: there is no flat surface to continue";
    return patch;
  }
  const SurfaceMap& map = below->map;
  const Ground ground = ground_of(map, scene, labels, is_gone, below->views, job);
  if (job.cancelled()) return patch;
  const Mask hole = hole_of(ground);
  if (count(hole) < kLeastCells)
    patch.why_not = "there is no hole in what the object stands on";
  else
    fill_hole(hole, scene.cloud(), map, ground, &patch, job);
  return patch;
}

}  // namespace splatcut
