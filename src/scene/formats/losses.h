// The sentence on what an export loses, put together from its clauses. Internal to src/scene/formats.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scene/formats/scene_file.h"

namespace splatcut {

class Losses {
 public:
  void add(std::string_view clause);  // nothing for an empty one
  // "positions are rounded to 24 bits; the mark of antialiased training is left out"
  const std::string& sentence() const { return text_; }
  // The same with a capital and a full stop; nothing for none.
  std::string in_full() const;

 private:
  std::string text_;
};

// A clause on the share of Gaussians with a value beyond [least, most] in any component of the colour
// (f_dc), of the logarithm of the scale, or in any SH coefficient. Empty where there are none.
struct Reach {
  float least, most;
};
std::string clamped_colours(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians,
                            const Reach& f_dc);
std::string clamped_log_scales(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians,
                               const Reach& log_scale);
std::string clamped_sh(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians, const Reach& sh);

// For formats that cannot hold them.
std::string properties_left_out(const Scene& scene);
// For formats whose positions have 32 bits or less.
std::string origin_left_out(const Scene& scene);
// For formats that cannot say it.
std::string antialiasing_left_out(const Scene& scene);

// All of them, for plans.
std::vector<std::uint32_t> all_gaussians(const GaussianCloud& cloud);

}  // namespace splatcut
