// A neighbourhood that a session keeps, and requests cut down for it. Included by the files of Session alone.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "segment/session/session.h"

namespace splatcut {

// Sets of Gaussians that strokes may affect, as a neighbourhood numbers them.
class SeenSets {
 public:
  SeenGaussians in(const Neighbourhood& near, const SeenGaussians& seen) {
    if (!seen || near.row.empty()) return seen;
    constexpr std::size_t kMostSets = 8;
    const auto known = std::ranges::find(sets_, seen, &std::pair<SeenGaussians, SeenGaussians>::first);
    if (known != sets_.end()) return known->second;
    if (sets_.size() == kMostSets) sets_.erase(sets_.begin());
    sets_.emplace_back(seen,
                       std::make_shared<const std::vector<std::uint8_t>>(in_neighbourhood(near, *seen)));
    return sets_.back().second;
  }

 private:
  std::vector<std::pair<SeenGaussians, SeenGaussians>> sets_;
};

struct KeptNeighbourhood {
  KeptNeighbourhood(Neighbourhood made, const WholeScene& scene)
      : near(std::move(made)), session({near.cloud, near.prepared, scene.up_world, scene.capture}) {}

  std::size_t bytes() const { return near.bytes() + session.bytes(); }

  Neighbourhood near;
  LocalSession session;
  SeenSets seen;
};

inline bool by_parts(const CutSettings& settings) {
  return settings.first_mask_from == FirstMaskFrom::kParts;
}

// Labels of the neighbourhood's Gaussians. object_rows: of the scene, ascending.
SeenGaussians labels_in(const Neighbourhood& near, const std::vector<std::uint32_t>& object_rows);

// These strokes alone, asked for as `like` asks.
CutRequest request_of(std::span<const CameraStroke> strokes, const CutRequest& like);
// The first stroke on the object alone, its likeliest meaning in its own size.
CutRequest first_of(const CutRequest& request);
int first_size_step(const CutRequest& request);  // Stroke::size_step of the first stroke on the object

}  // namespace splatcut
