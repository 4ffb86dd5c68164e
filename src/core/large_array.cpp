#include "core/large_array.h"

#include <sys/mman.h>
#include <tbb/parallel_for.h>

#include <cstdint>

namespace splatcut {

void advise_large_pages(void* data, std::size_t bytes) {
  const auto address = reinterpret_cast<std::uintptr_t>(data);
  const std::uintptr_t begin = (address + kLargePageBytes - 1) & ~(kLargePageBytes - 1);
  const std::uintptr_t end = (address + bytes) & ~(kLargePageBytes - 1);
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

void touch_large_pages(void* data, std::size_t bytes) {
  tbb::parallel_for(std::size_t{0}, (bytes + kLargePageBytes - 1) / kLargePageBytes, [&](std::size_t page) {
    static_cast<volatile std::byte*>(data)[page * kLargePageBytes] = std::byte{0};
  });
}

}  // namespace splatcut
