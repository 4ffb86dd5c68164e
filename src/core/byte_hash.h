// A 64-bit hash of bytes, for keys and checksums; not for adversaries. XXH3 of libxxhash: the same on every
// machine. Cost: about as long as reading the memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <type_traits>

namespace splatcut {

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed = 0);

// Throws Error for a file that cannot be read.
std::uint64_t hash_of_file(const std::filesystem::path& path);

// Of the file of the running program; 0 where it cannot be read. Results kept by another build are told by
// it.
std::uint64_t hash_of_program();

// Adds things up to one hash, in order.
class Hasher {
 public:
  explicit Hasher(std::uint64_t seed = 0) : hash_(seed) {}
  void add(std::span<const std::byte> bytes) { hash_ = hash_bytes(bytes, hash_); }
  template <class T>
  void add(std::span<const T> values) {
    static_assert(std::has_unique_object_representations_v<T> || sizeof(T) % sizeof(float) == 0);
    add(std::as_bytes(values));
  }
  // One number: padding and the order of members play no part.
  template <class Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    add(std::as_bytes(std::span(&value, 1)));
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_;
};

}  // namespace splatcut
