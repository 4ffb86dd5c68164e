#include "scene/packing/unpack.h"

#include <fmt/format.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <memory>
#include <new>

#include "core/error.h"
#include "scene/packing/incomplete.h"

namespace splatcut {

namespace {

constexpr std::size_t kFirstBuffer = 1 << 22;

// Unpacked between two looks at the stop token: some 10 ms.
constexpr std::size_t kChunk = 1 << 22;

void grow(Bytes& bytes, std::size_t wanted) {
  bytes.resize(std::min(wanted, std::max(kFirstBuffer, 2 * bytes.size())));
}

}  // namespace

void check_expansion(const std::filesystem::path& path, std::uint64_t packed_bytes,
                     std::uint64_t unpacked_bytes) {
  constexpr std::uint64_t kMostFold = 256, kAlways = 16 << 20;
  if (unpacked_bytes <= kAlways || unpacked_bytes / kMostFold <= packed_bytes) return;
  throw Error(path.string(),
              fmt::format("is damaged: its {} bytes promise {} unpacked, and no scene packs so well",
                          packed_bytes, unpacked_bytes));
}

GzipReader::GzipReader(const MappedFile& file) : GzipReader(file.path(), file.bytes(), 16 + MAX_WBITS) {
  header_.comment = reinterpret_cast<Bytef*>(comment_.data());
  header_.comm_max = kMostComment;
  inflateGetHeader(&stream_, &header_);
}

GzipReader::GzipReader(std::filesystem::path path, std::span<const std::byte> data, int window_bits)
    : path_(std::move(path)), in_(data) {
  const int result = inflateInit2(&stream_, window_bits);
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  if (result != Z_OK) throw Error(path_.string(), "the gzip reader failed to start");
}

Bytes GzipReader::read(std::size_t count, const Job& job) {
  Bytes out;
  for (std::size_t done = 0; done < count && !job.cancelled();) {
    if (done == out.size()) grow(out, count);
    const std::size_t more = read_some(std::span(out).subspan(done));
    if (more == 0) throw_truncated(done);
    done += more;
  }
  return out;
}

Bytes GzipReader::read_rest(std::size_t most) {
  Bytes out(most);
  std::size_t done = 0;
  while (done < most) {
    const std::size_t more = read_some(std::span(out).subspan(done));
    if (more == 0) break;
    done += more;
  }
  out.resize(done);
  return out;
}

void GzipReader::check_end() {
  constexpr std::size_t kMost = 1 << 20;
  Bytes ignored(kMost);
  for (std::size_t done = 0; !ended_ && done < kMost;) {
    const bool starved = in_.empty();
    const std::size_t more = read_some(std::span(ignored).subspan(done));
    if (more == 0 && starved && !ended_) throw_truncated(done);
    done += more;
  }
}

void GzipReader::throw_truncated(std::size_t done) const {
  throw Error(path_.string(), incomplete(fmt::format("the gzip data ends at byte {} after {} unpacked bytes",
                                                     size_ - in_.size(), done)));
}

std::size_t GzipReader::read_some(std::span<std::byte> out) {
  const auto in = in_.first(std::min(in_.size(), kChunk));
  stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(in.data()));
  stream_.avail_in = static_cast<uInt>(in.size());
  stream_.next_out = reinterpret_cast<Bytef*>(out.data());
  const std::size_t room = std::min(out.size(), kChunk);
  stream_.avail_out = static_cast<uInt>(room);
  const int result = inflate(&stream_, Z_NO_FLUSH);
  in_ = in_.subspan(in.size() - stream_.avail_in);
  const std::size_t written = room - stream_.avail_out;
  ended_ |= result == Z_STREAM_END;
  if (written > 0) return written;
  if (result == Z_OK || result == Z_STREAM_END || result == Z_BUF_ERROR) return 0;
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  throw Error(path_.string(), fmt::format("the gzip data is damaged at byte {}", size_ - in_.size()));
}

Bytes unpack_zstd(const MappedFile& file, std::span<const std::byte> packed, std::size_t size,
                  std::size_t index, const Job& job) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  if (!stream) throw std::bad_alloc();
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  Bytes bytes;
  for (std::size_t done = 0; done < size && !job.cancelled();) {
    if (done == bytes.size()) grow(bytes, size);
    ZSTD_outBuffer out{bytes.data(), std::min(bytes.size(), done + kChunk), done};
    const std::size_t result = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_getErrorCode(result) == ZSTD_error_memory_allocation) throw std::bad_alloc();
    if (ZSTD_isError(result))
      throw Error(file.path().string(),
                  fmt::format("stream {} is damaged ({})", index, ZSTD_getErrorName(result)));
    if (out.pos == done && in.pos == in.size)
      throw Error(file.path().string(),
                  fmt::format("stream {} ends after {} of {} bytes", index, done, size));
    done = out.pos;
  }
  return bytes;
}

}  // namespace splatcut
