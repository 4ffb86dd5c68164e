#include "core/byte_hash.h"

#include <xxhash.h>

#include "core/error.h"
#include "core/mapped_file.h"

namespace splatcut {

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

std::uint64_t hash_of_file(const std::filesystem::path& path) {
  return hash_bytes(MappedFile(path).bytes());
}

std::uint64_t hash_of_program() {
  static const std::uint64_t hash = [] {
    try {
      return hash_of_file("/proc/self/exe");
    } catch (const Error&) {
      return std::uint64_t{0};
    }
  }();
  return hash;
}

}  // namespace splatcut
