#include "scene/formats/losses.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "scene/formats/far_origin.h"

namespace splatcut {

namespace {

// The logarithm of 0 is within: what is flat is written so thin that it stays flat.
bool beyond(float value, const Reach& range) {
  return (value < range.least && std::isfinite(value)) || value > range.most;
}
bool beyond(const glm::vec3& v, const Reach& range) {
  return beyond(v.x, range) || beyond(v.y, range) || beyond(v.z, range);
}

template <class Test>
std::string clamped(const char* what, std::span<const std::uint32_t> gaussians, const Test& test) {
  std::atomic<std::size_t> all = 0;
  for_chunks(gaussians.size(), [&](std::size_t from, std::size_t to) {
    std::size_t some = 0;
    for (std::size_t i = from; i < to; ++i) some += test(gaussians[i]);
    all += some;
  });
  const std::size_t count = all;
  if (count == 0) return {};
  const double percent = 100.0 * static_cast<double>(count) / static_cast<double>(gaussians.size());
  const std::string share = percent < 0.1 ? "under 0.1 %" : fmt::format("{:.1f} %", percent);
  return fmt::format("the {} of {} of the Gaussians lie beyond the format's range and are clamped", what,
                     share);
}

}  // namespace

void Losses::add(std::string_view clause) {
  if (clause.empty()) return;
  if (!text_.empty()) text_ += "; ";
  text_ += clause;
}

std::string Losses::in_full() const {
  if (text_.empty()) return {};
  std::string text = text_ + ".";
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string clamped_colours(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians,
                            const Reach& f_dc) {
  return clamped("colours", gaussians, [&](std::uint32_t g) { return beyond(cloud.f_dc[g], f_dc); });
}

std::string clamped_log_scales(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians,
                               const Reach& log_scale) {
  return clamped("sizes", gaussians,
                 [&](std::uint32_t g) { return beyond(glm::log(cloud.scale[g]), log_scale); });
}

std::string clamped_sh(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians,
                       const Reach& sh) {
  return clamped("spherical harmonics", gaussians, [&](std::uint32_t g) {
    const std::span<const float> rest = cloud.sh_rest_of(g);
    return std::ranges::any_of(rest, [&](float v) { return beyond(v, sh); });
  });
}

std::string properties_left_out(const Scene& scene) {
  const std::vector<std::string>& others = scene.other_properties;
  if (others.empty()) return {};
  if (others.size() == 1) return fmt::format("the property \"{}\" is left out", others[0]);
  return fmt::format("{} properties are left out, \"{}\" among them", others.size(), others[0]);
}

std::string origin_left_out(const Scene& scene) {
  return scene.origin == glm::dvec3(0)
             ? ""
             : fmt::format("positions are those of the source less {}", spoken(scene.origin));
}

std::string antialiasing_left_out(const Scene& scene) {
  return scene.cloud.antialiased ? "the mark that the scene was trained with antialiasing is left out" : "";
}

std::vector<std::uint32_t> all_gaussians(const GaussianCloud& cloud) {
  std::vector<std::uint32_t> all(cloud.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

}  // namespace splatcut
