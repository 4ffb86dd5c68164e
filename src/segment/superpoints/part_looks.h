// What views show of each part of a tree, summed: how a part looks from wherever the scene was looked at, not
// only from where the user happens to stand.
//
// In: per view which leaf each pixel shows, and how far it lies. Out: per node of a tree the sums over views.
// Cost: some 20 ms a view of 160 pixels on two cores, nearly all of it drawing. Sums are in the order of the
// views: same input, same bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/raster/projected_view.h"

namespace splatcut {

struct PartHierarchy;

// Of each picture: areas as shares of it, lengths in sides of a square picture of that area. A view counts
// the same whatever its size in pixels.
struct PartLooks {
  float area = 0;          // that shows it
  float area_squared = 0;  // sum over views of the area's square
  float side = 0;          // sum of the area's square root,
  float cropped_side = 0;  // and that of views alone in which it touches the picture's frame
  float frame = 0;         // along the picture's frame
  float border = 0;        // to what is not the part
  float plain_border = 0;  // of that, where the depth does not jump

  PartLooks& operator+=(const PartLooks& other);
  bool operator==(const PartLooks&) const = default;
};

// A view as leaves. Both of one size.
struct LeafPicture {
  Image<std::uint32_t> leaf;  // the one that makes most of the pixel; kNoPart where hardly anything is
  Image<float> depth;         // camera z, 0 where nothing is
};

// Per tree and node.
std::vector<std::vector<PartLooks>> looks_in(const PartHierarchy& parts, const LeafPicture& picture);

// Draws the views and fills the looks of every tree. Cancelled: incomplete.
void look_at_parts(const Drawer& drawer, std::span<const Camera> views, PartHierarchy* parts,
                   const Job& job = {});

}  // namespace splatcut
