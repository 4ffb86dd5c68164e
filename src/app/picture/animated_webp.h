// Pictures one after the other as an animated WebP that begins again for ever.
//
// Frames are lossy (quality 85) with lossless alpha, none depends on the one before. Container: RIFF with the
// chunks VP8X, ANIM and an ANMF per frame (WebP Container Specification). At most 16384 pixels a side, 4 GiB.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/image.h"

namespace splatcut {

class AnimatedWebp {
 public:
  static constexpr std::size_t kMostBytes = 0xffffff00;  // sizes of chunks have 32 bits
  explicit AnimatedWebp(int frame_ms, std::size_t most_bytes = kMostBytes)
      : frame_ms_(frame_ms), most_bytes_(most_bytes) {}
  void add(const Image<Rgba8>& picture);  // all of one size, straight alpha; throws Error
  std::vector<std::byte> bytes() const;   // of the whole file; at least one frame

 private:
  int frame_ms_;
  std::size_t most_bytes_;
  int width_px_ = 0, height_px_ = 0;
  std::vector<std::byte> frames_;  // ANMF chunks
};

}  // namespace splatcut
