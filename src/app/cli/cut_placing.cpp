#include "app/cli/cut_placing.h"

#include <fmt/format.h>

#include <cmath>
#include <locale>
#include <sstream>
#include <string_view>

#include "core/error.h"
#include "segment/session/stroke_hits.h"

namespace splatcut {

namespace {

constexpr const char* kOption = "--scale-by";

struct KnownLength {
  glm::vec2 from_px{0}, to_px{0};
  float metres = 0;
};

KnownLength known_length_of(const std::string& text) {
  KnownLength known;
  char comma[4] = {}, rest = 0;
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  in >> known.from_px.x >> comma[0] >> known.from_px.y >> comma[1] >> known.to_px.x >> comma[2] >>
      known.to_px.y >> comma[3] >> known.metres;
  if (!in || std::string_view(comma, 4) != ",,,," || in >> rest)
    throw Error(kOption, fmt::format("\"{}\" is no known length", text), "Write x0,y0,x1,y1,metres");
  if (!(known.metres > 0)) throw Error(kOption, "the metres are not larger than 0");
  return known;
}

glm::vec3 place_at(const glm::vec2& pixel, const Drawer& scene, const Camera& camera, const Job& job) {
  const std::string at = fmt::format("the pixel {},{}", pixel.x, pixel.y);
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < static_cast<float>(camera.width_px) &&
        pixel.y < static_cast<float>(camera.height_px)))
    throw Error(kOption,
                fmt::format("{} lies outside of the {}x{} picture", at, camera.width_px, camera.height_px));
  const StrokeHits hits = stroke_hits(scene, {camera, click(pixel, SeedLabel::kObject), {}}, job);
  if (hits.front()) return *hits.front();
  if (job.cancelled()) return {};
  throw Error(kOption, at + " shows nothing of the scene", "Take one on a surface");
}

float factor_of(const KnownLength& known, const Drawer& scene, const Camera& camera, const Job& job) {
  const glm::vec3 from = place_at(known.from_px, scene, camera, job);
  const glm::vec3 to = place_at(known.to_px, scene, camera, job);
  const float factor = known.metres / glm::distance(from, to);
  if (job.cancelled()) return 1;
  if (from == to)
    throw Error(kOption, "both pixels show the same place", "Take two ends of what was measured");
  check_factor(factor, kOption);
  return factor;
}

}  // namespace

void check_factor(float factor, const std::string& where) {
  constexpr float kLeast = 1e-6f, kMost = 1e6f;
  if (!(factor >= kLeast && factor <= kMost))
    throw Error(
        where, fmt::format("makes all {:g} times as large: {:g} to {:g} is possible", factor, kLeast, kMost));
}

ExportPlacement placement_of(const CutoutOptions& options, const Drawer& scene, const Camera& camera,
                             const Job& job) {
  ExportPlacement placement = placement_by_name(options.origin, options.up);
  if (!options.known_length.empty())
    placement.scale = factor_of(known_length_of(options.known_length), scene, camera, job);
  return placement;
}

std::optional<glm::vec3> up_to_write(const ChosenCamera& chosen, const ExportPlacement& placement) {
  if (chosen.up_is_guess && placement.up == ExportUp::kScene) return {};
  return chosen.up_world;
}

}  // namespace splatcut
