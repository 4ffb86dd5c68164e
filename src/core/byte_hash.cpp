#include "core/byte_hash.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "core/mapped_file.h"

namespace splatcut {

namespace {

__extension__ typedef unsigned __int128 Product;

constexpr std::size_t kPiece = 1 << 20, kLanes = 4, kStep = kLanes * sizeof(std::uint64_t);

// Odd, with bits of no pattern: the fractional digits of the square roots of 2, 3, 5, 7 and 11.
constexpr std::array<std::uint64_t, kLanes> kKey = {0x6a09e667f3bcc909, 0xbb67ae8584caa73b,
                                                    0x3c6ef372fe94f82b, 0xa54ff53a5f1d36f1};
constexpr std::uint64_t kLast = 0x510e527fade682d1;

std::uint64_t fold(std::uint64_t a, std::uint64_t b) {
  const Product p = static_cast<Product>(a) * b;
  return static_cast<std::uint64_t>(p) ^ static_cast<std::uint64_t>(p >> 64);
}

std::uint64_t hash_piece(const std::byte* bytes, std::size_t size, std::uint64_t seed) {
  std::array<std::uint64_t, kLanes> lane{};
  for (std::size_t i = 0; i < kLanes; ++i) lane[i] = seed ^ kKey[i];
  std::array<std::uint64_t, kLanes> word{};
  const auto take = [&] {
    for (std::size_t i = 0; i < kLanes; ++i)
      lane[i] = fold(lane[i] ^ word[i], kKey[i]) + word[i];  // + : no word can zero a lane for good
  };
  std::size_t at = 0;
  for (; at + kStep <= size; at += kStep) {
    std::memcpy(word.data(), bytes + at, kStep);
    take();
  }
  word = {};
  if (at < size) std::memcpy(word.data(), bytes + at, size - at);  // bytes of nothing may be null
  take();
  std::uint64_t hash = fold(size ^ kLast, seed ^ kKey[0]);
  for (const std::uint64_t l : lane) hash = fold(hash ^ l, kLast);
  return hash;
}

}  // namespace

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed) {
  if (bytes.size() <= kPiece) return hash_piece(bytes.data(), bytes.size(), seed);
  std::vector<std::uint64_t> of_piece((bytes.size() + kPiece - 1) / kPiece);
  tbb::parallel_for(std::size_t{0}, of_piece.size(), [&](std::size_t i) {
    of_piece[i] = hash_piece(bytes.data() + i * kPiece, std::min(kPiece, bytes.size() - i * kPiece), seed);
  });
  return hash_piece(reinterpret_cast<const std::byte*>(of_piece.data()),
                    of_piece.size() * sizeof(std::uint64_t), seed);
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
