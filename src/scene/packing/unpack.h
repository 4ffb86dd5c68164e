// Packed data, piece by piece: memory is taken as data arrives, so that a small file that promises much is
// refused at little cost, and a stop is heard. Internal to src/scene.
#pragma once

#include <zlib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/job.h"
#include "core/mapped_file.h"

namespace splatcut {

using Bytes = std::vector<std::byte>;

// Throws Error if data would unpack to more than 256 times their bytes and 16 MiB: no scene packs so well,
// and a small file must not take all memory. The cloud takes at most six times the memory of the rows it is
// made of, of a .sog with spherical harmonics eleven times.
void check_expansion(const std::filesystem::path& path, std::uint64_t packed_bytes,
                     std::uint64_t unpacked_bytes);

// One gzip stream, or one of deflate. Throws Error for data that are damaged.
class GzipReader {
 public:
  explicit GzipReader(const MappedFile& file);
  // path: of the file that the data are from. window_bits: as inflateInit2() wants them.
  GzipReader(std::filesystem::path path, std::span<const std::byte> data, int window_bits);
  GzipReader(const GzipReader&) = delete;
  GzipReader& operator=(const GzipReader&) = delete;
  ~GzipReader() { inflateEnd(&stream_); }

  // Throws Error where the data end before. Fewer bytes when cancelled.
  Bytes read(std::size_t count, const Job& job);
  // Of the header, once something was read; cut to kMostComment.
  std::string comment() const { return comment_.data(); }
  // What is left, but no more than the bytes given.
  Bytes read_rest(std::size_t most);
  // Unpacks what is left, up to 1 MiB. Throws Error where the data end before they are whole, or do not fit
  // their checksum.
  void check_end();

 private:
  [[noreturn]] void throw_truncated(std::size_t done) const;
  std::size_t read_some(std::span<std::byte> out);  // 0 at the end of the data

  std::filesystem::path path_;
  std::span<const std::byte> in_;
  std::size_t size_ = in_.size();
  bool ended_ = false;  // true: the stream was whole, and fitted its checksum
  static constexpr std::size_t kMostComment = 127;
  std::array<char, kMostComment + 1> comment_{};
  gz_header header_{};
  z_stream stream_{};
};

// Stream number `index` of the file, which unpacks to `size` bytes; Error where it does not. Incomplete when
// cancelled.
Bytes unpack_zstd(const MappedFile& file, std::span<const std::byte> packed, std::size_t size,
                  std::size_t index, const Job& job);

}  // namespace splatcut
