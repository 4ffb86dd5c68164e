#include "scene/large_array.h"

#include <sys/mman.h>

#include <cstdint>

namespace splatcut {

void advise_large_pages(void* data, std::size_t bytes) {
  const auto address = reinterpret_cast<std::uintptr_t>(data);
  const std::uintptr_t begin = (address + kLargePageBytes - 1) & ~(kLargePageBytes - 1);
  const std::uintptr_t end = (address + bytes) & ~(kLargePageBytes - 1);
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace splatcut
