#include "segment/session/session_among.h"

#include <algorithm>

namespace splatcut {

namespace {

Neighbourhood part_of(const SessionScene& scene, const std::vector<std::uint8_t>& set) {
  Neighbourhood part{};
  for (std::uint32_t g = 0; g < set.size(); ++g)
    if (set[g]) part.row.push_back(g);
  part.cloud = std::make_shared<const GaussianCloud>(permuted(*scene.cloud, part.row));
  return part;
}

SessionScene scene_of(SessionScene scene, const Neighbourhood& part) {
  scene.cloud = part.cloud;
  scene.blocks = nullptr;
  scene.most_bytes /= 2;  // two such sessions keep as much as the scene's own
  return scene;
}

}  // namespace

SessionAmong::SessionAmong(const SessionScene& scene, const SeenGaussians& set_)
    : set(set_), part(part_of(scene, *set)), session(scene_of(scene, part)) {}

CutRequest SessionAmong::here(CutRequest request) {
  for (StrokedView& view : request.strokes) view.seen = seen.in(part, view.seen);
  request.among = nullptr;
  return request;
}

CameraStroke SessionAmong::here(CameraStroke stroke) {
  stroke.seen = seen.in(part, stroke.seen);
  return stroke;
}

CutResult SessionAmong::in_scene(CutResult result) const {
  result.labels = in_scene(std::move(result.labels));
  result.prior = in_scene(std::move(result.prior));
  result.said = in_scene(std::move(result.said));
  return result;
}

OnSnapshot SessionAmong::in_scene(const OnSnapshot& on_snapshot) const {
  if (!on_snapshot) return {};
  return
      [this, &on_snapshot](CutPhase phase, const CutResult& so_far) { on_snapshot(phase, in_scene(so_far)); };
}

// Null: all of the scene, or nothing of it, where strokes hit nothing either.
SessionAmong* Session::among(const CutRequest& request) {
  constexpr std::size_t kMostKept = 2;
  const auto is_set = [](std::uint8_t byte) { return byte != 0; };
  const SeenGaussians& set = request.among;
  if (!set || std::ranges::all_of(*set, is_set) || std::ranges::none_of(*set, is_set)) return nullptr;
  const auto known =
      std::ranges::find_if(among_, [&](const SessionAmong& a) { return same_set(a.set, set); });
  if (known != among_.end())
    among_.splice(among_.begin(), among_, known);
  else
    among_.emplace_front(scene_, set);
  if (among_.size() > kMostKept) among_.pop_back();
  return &among_.front();
}

}  // namespace splatcut
