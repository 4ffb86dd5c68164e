#include "scene/decode.h"

#include <sys/mman.h>

namespace splatcut {

namespace {

template <class T>
void reserve_in_large_pages(std::vector<T>& values, std::size_t n) {
  values.reserve(n);
  constexpr std::uintptr_t kLargePage = 1 << 21;
  const std::uintptr_t begin =
      (reinterpret_cast<std::uintptr_t>(values.data()) + kLargePage - 1) & ~(kLargePage - 1);
  const std::uintptr_t end =
      (reinterpret_cast<std::uintptr_t>(values.data()) + n * sizeof(T)) & ~(kLargePage - 1);
  // Only advice: without large pages everything works, slower.
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace

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
