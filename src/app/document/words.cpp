#include "app/document/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace splatcut {

std::string grouped(std::size_t n) {
  if (n < 1000) return fmt::format("{}", n);
  return fmt::format("{},{:03}", grouped(n / 1000), n % 1000);
}

std::string gaussians_text(std::size_t n) {
  return grouped(n) + (n == 1 ? " Gaussian" : " Gaussians");
}

std::string length_text(float length) {
  const float size = std::abs(length);
  if (!(size > 0)) return "0";
  if (size >= 1000 && size < 1e9f)
    return fmt::format("{}{}", length < 0 ? "-" : "", grouped(static_cast<std::size_t>(std::lround(size))));
  if (size < 1e-4f || size >= 1e9f) return fmt::format("{:.2e}", length);
  return fmt::format("{:.{}f}", length, std::max(0, 2 - static_cast<int>(std::floor(std::log10(size)))));
}

}  // namespace splatcut
