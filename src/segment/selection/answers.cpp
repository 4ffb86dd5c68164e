// The answers of a click's own view, and of a first click those of the wider one.
#include <algorithm>
#include <cmath>
#include <utility>

#include "segment/selection/candidates.h"

namespace splatcut {

namespace {

constexpr float kCoarse = -1.8f;  // grain of a picture from too near

// The pixel of another focal length that looks the same way.
glm::ivec2 same_ray(const Camera& from, const Camera& to, const glm::ivec2& at) {
  const glm::vec2 pixel = glm::vec2(at) + 0.5f;
  return {static_cast<int>(std::floor((pixel.x - from.cx_px) / from.fx_px * to.fx_px + to.cx_px)),
          static_cast<int>(std::floor((pixel.y - from.cy_px) / from.fy_px * to.fy_px + to.cy_px))};
}

// How large the leaves around the click are in the picture: weighted median of ln(side / picture's width).
// Superpoints hold alike many splats, and captures have splats as fine as their photographs saw: it says how
// near the user stands for this scene.
float grain(const PartHierarchy& parts, const Click& click) {
  constexpr float kAround = 0.075f;  // of the picture's width
  const Camera& camera = click.view.camera;
  const auto width = static_cast<float>(camera.width_px);
  const int reach = static_cast<int>(kAround * width);
  std::vector<float> px(parts.leaves, 0);
  float all_px = 0;
  for (int y = std::max(0, click.at.y - reach); y <= std::min(camera.height_px - 1, click.at.y + reach); ++y)
    for (int x = std::max(0, click.at.x - reach); x <= std::min(camera.width_px - 1, click.at.x + reach); ++x)
      for (const GroupWeight& w : click.view.leaves.at(static_cast<std::size_t>(y) * camera.width_px + x)) {
        px[w.group] += w.weight;
        all_px += w.weight;
      }
  std::vector<std::pair<float, float>> sizes;  // with pixels
  for (std::uint32_t leaf = 0; leaf < parts.leaves; ++leaf)
    if (px[leaf] > 0) {
      const float depth = std::max(camera.camera_from_world(parts.leaf_centre_world[leaf]).z, 1e-15f);
      const float side = std::sqrt(std::max(parts.leaf_area[leaf], 1e-30f)) * camera.fx_px / depth;
      sizes.emplace_back(std::log(side / width), px[leaf]);
    }
  std::ranges::sort(sizes);
  float sum = 0;
  for (const auto& [size, weight] : sizes)
    if ((sum += weight) >= all_px / 2) return size;
  return 0;
}

// Of each candidate the view counts in which it costs less.
void join(const Answers& wide, float weight_of_wide, float unlikely, bool keep_both, Answers* found) {
  for (Candidate other : wide.candidates) {
    weight(&other.terms, Term::kWider) = unlikely;
    other.cost += weight_of_wide * unlikely;
    const auto known = std::ranges::find_if(found->candidates, [&](const Candidate& c) {
      return c.chain == other.chain && c.index == other.index;
    });
    if (known == found->candidates.end() || keep_both)
      found->candidates.push_back(other);
    else if (other.cost < known->cost)
      *known = other;
  }
  std::ranges::stable_sort(found->candidates, {}, &Candidate::cost);
}

}  // namespace

Answers answers(const PartHierarchy& parts, const SelectedParts& selected, const Click& click,
                const SelectionModel& model, const AnswerOptions& options) {
  Answers found = answers_in_view(parts, selected, click, model, options);
  if (!click.wide) return found;
  const Camera &near = click.view.camera, &far = click.wide->camera;
  const glm::ivec2 at = same_ray(near, far, click.at);
  if (!click.displayed.contains(at.x, at.y)) return found;
  const Click there{*click.wide,     at,     click.object, click.first, click.leaf, click.radius_px,
                    click.displayed, nullptr};
  const float unlikely = std::log(near.fx_px / far.fx_px) * std::max(0.0f, kCoarse - grain(parts, click));
  join(answers_in_view(parts, selected, there, model, options), weight(model.first, Term::kWider), unlikely,
       options.all_terms, &found);
  return found;
}

}  // namespace splatcut
