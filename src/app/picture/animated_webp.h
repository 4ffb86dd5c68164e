// Pictures as the frames of an animated WebP that repeats for ever.
//
// Frames are lossy (quality 85) with lossless alpha; no frame depends on the one before. Memory: the packed
// frames. Limits: 16384 pixels a side, 4 GiB.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/image.h"

struct WebPMux;

namespace splatcut {

class AnimatedWebp {
 public:
  static constexpr std::size_t kMostBytes = 0xffffff00;  // limit, as sizes of chunks have 32 bits
  explicit AnimatedWebp(int frame_ms, std::size_t most_bytes = kMostBytes);
  // Adds a frame. All pictures must have one size and straight alpha. Throws Error if the picture cannot be
  // packed, or if the file would be larger than most_bytes.
  void add(const Image<Rgba8>& picture);
  std::vector<std::byte> bytes() const;  // the whole file; it must have at least one frame

 private:
  int frame_ms_;
  std::size_t most_bytes_, frame_bytes_ = 0;
  std::unique_ptr<WebPMux, void (*)(WebPMux*)> mux_;
};

}  // namespace splatcut
