#include "scene/cloud/scene_memory.h"

#include <fmt/format.h>

#include <fstream>
#include <limits>
#include <string>

#include "core/error.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

std::uint64_t memory_of_scene(std::uint64_t gaussians, int sh_degree) {
  constexpr std::uint64_t kOfEach = 100;  // of the cloud 60; order, positions and splats of a drawing
  return gaussians *
         (kOfEach + 3 * sizeof(float) * static_cast<std::uint64_t>(sh_rest_coefficients(sh_degree)));
}

std::optional<std::uint64_t> available_memory() {
  std::ifstream file("/proc/meminfo");
  constexpr std::uint64_t kKib = 1024;
  for (std::string name; file >> name; file.ignore(std::numeric_limits<std::streamsize>::max(), '\n'))
    if (std::uint64_t kib = 0; name == "MemAvailable:" && file >> kib) return kKib * kib;
  return {};
}

void check_memory(const std::filesystem::path& file, std::uint64_t gaussians, int sh_degree,
                  std::optional<std::uint64_t> available) {
  const std::uint64_t needed = memory_of_scene(gaussians, sh_degree);
  if (!available || needed <= *available) return;
  constexpr double kGb = 1e9;
  throw Error(
      file.string(),
      fmt::format("{} Gaussians of degree {} take {:.1f} GB of memory, and {:.1f} GB are free", gaussians,
                  sh_degree, static_cast<double>(needed) / kGb, static_cast<double>(*available) / kGb),
      "End other programs, take a coarser level (--lod, of a streamed scene), or a file with fewer "
      "Gaussians or a lower degree of spherical harmonics");
}

}  // namespace splatcut
