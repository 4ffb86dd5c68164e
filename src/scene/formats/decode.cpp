#include "scene/formats/decode.h"

#include "core/large_array.h"

namespace splatcut {

namespace {

template <class T>
void reserve_in_large_pages(std::vector<T>& values, std::size_t n) {
  values.reserve(n);
  advise_large_pages(values.data(), n * sizeof(T));
  touch_large_pages(values.data(), n * sizeof(T));  // the zeros of resize() would do it on one thread
}

}  // namespace

void check_cloud_size(const std::filesystem::path& path, std::uint64_t packed_bytes, std::uint64_t gaussians,
                      int degree) {
  constexpr std::uint64_t kGaussianBytes = 68, kMostFold = 6;
  const auto coefficients = static_cast<std::uint64_t>(sh_rest_coefficients(degree));
  check_expansion(path, packed_bytes,
                  gaussians * (kGaussianBytes + 3 * sizeof(float) * coefficients) / kMostFold);
}

void resize_for_decode(GaussianCloud& cloud, std::size_t n, int degree) {
  cloud.sh_degree = degree;
  reserve_in_large_pages(cloud.position, n);
  reserve_in_large_pages(cloud.scale, n);
  reserve_in_large_pages(cloud.rotation, n);
  reserve_in_large_pages(cloud.opacity, n);
  reserve_in_large_pages(cloud.f_dc, n);
  reserve_in_large_pages(cloud.sh_rest, n * cloud.sh_stride());
  reserve_in_large_pages(cloud.file_row, n);
  cloud.resize(n, degree);
}

}  // namespace splatcut
