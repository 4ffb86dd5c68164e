// A neighbourhood that a session keeps, and requests cut down for it. Included by the files of Session alone.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "segment/session/session.h"

namespace splatcut {

struct KeptNeighbourhood {
  KeptNeighbourhood(Neighbourhood made, const SessionScene& scene)
      : near(std::move(made)), session({near.cloud, near.prepared, scene.up_world, scene.photographs}) {}

  // Sets of Gaussians that strokes may affect, as the neighbourhood numbers them.
  SeenGaussians seen_here(const SeenGaussians& seen) {
    if (!seen || near.row.empty()) return seen;
    constexpr std::size_t kMostSets = 8;
    const auto known = std::ranges::find(sets, seen, &std::pair<SeenGaussians, SeenGaussians>::first);
    if (known != sets.end()) return known->second;
    if (sets.size() == kMostSets) sets.erase(sets.begin());
    sets.emplace_back(seen, std::make_shared<const std::vector<std::uint8_t>>(in_neighbourhood(near, *seen)));
    return sets.back().second;
  }

  Neighbourhood near;
  LocalSession session;
  std::vector<std::pair<SeenGaussians, SeenGaussians>> sets;
  bool told = false;  // its stages stand in a result
};

inline bool by_parts(const CutSettings& settings) {
  return settings.first_mask_from == FirstMaskFrom::kParts;
}

// These strokes alone, asked for as `like` asks.
CutRequest request_of(std::span<const CameraStroke> strokes, const CutRequest& like);
// The first stroke on the object alone, and its likeliest meaning.
CutRequest first_of(const CutRequest& request);

}  // namespace splatcut
