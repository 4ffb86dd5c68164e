#include "app/picture/animated_webp.h"

#include <webp/encode.h>
#include <webp/mux.h>

#include <cassert>
#include <cstdint>
#include <new>

#include "core/error.h"

namespace splatcut {

namespace {

// Bytes that libwebp allocated.
class WebpBytes {
 public:
  WebpBytes() { WebPDataInit(&data_); }
  ~WebpBytes() { WebPDataClear(&data_); }
  WebpBytes(const WebpBytes&) = delete;
  WebpBytes& operator=(const WebpBytes&) = delete;
  WebPData* get() { return &data_; }

 private:
  WebPData data_;
};

// WebPMux reports a lack of memory like any other fault; the faults besides it are ours.
void check(WebPMuxError error) {
  if (error == WEBP_MUX_MEMORY_ERROR) throw std::bad_alloc();
  assert(error == WEBP_MUX_OK);
}

void encode(const Image<Rgba8>& picture, WebPData* still) {
  constexpr float kQuality = 85;
  std::uint8_t* bytes = nullptr;
  still->size = WebPEncodeRGBA(picture.pixels().data()->data(), picture.width(), picture.height(),
                               picture.width() * static_cast<int>(sizeof(Rgba8)), kQuality, &bytes);
  still->bytes = bytes;
  if (still->size == 0) throw Error("webp", "a picture could not be packed", "Take a smaller size");
}

}  // namespace

AnimatedWebp::AnimatedWebp(int frame_ms, std::size_t most_bytes)
    : frame_ms_(frame_ms), most_bytes_(most_bytes), mux_(WebPMuxNew(), WebPMuxDelete) {
  if (!mux_) throw std::bad_alloc();
}

void AnimatedWebp::add(const Image<Rgba8>& picture) {
  constexpr std::size_t kOfFile = 44, kOfFrame = 12;  // headers beside those of the stills: at most
  WebpBytes still;
  encode(picture, still.get());
  frame_bytes_ += still.get()->size + kOfFrame;
  if (kOfFile + frame_bytes_ > most_bytes_)
    throw Error("webp", "the animation is larger than a file of this kind can be",
                "Take fewer or smaller pictures");
  WebPMuxFrameInfo frame{};
  frame.bitstream = *still.get();
  frame.duration = frame_ms_;
  frame.id = WEBP_CHUNK_ANMF;
  frame.blend_method = WEBP_MUX_NO_BLEND;
  constexpr int kCopies = 1;
  check(WebPMuxPushFrame(mux_.get(), &frame, kCopies));
}

std::vector<std::byte> AnimatedWebp::bytes() const {
  const WebPMuxAnimParams for_ever_on_nothing{};
  check(WebPMuxSetAnimationParams(mux_.get(), &for_ever_on_nothing));
  WebpBytes file;
  check(WebPMuxAssemble(mux_.get(), file.get()));
  const auto* first = reinterpret_cast<const std::byte*>(file.get()->bytes);
  return {first, first + file.get()->size};
}

}  // namespace splatcut
