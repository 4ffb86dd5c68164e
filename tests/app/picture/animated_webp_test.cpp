// Animations, read back by libwebp's own player.
#include "app/picture/animated_webp.h"

#include <doctest/doctest.h>
#include <webp/demux.h>
#include <webp/encode.h>

#include <cstring>
#include <vector>

using namespace splatcut;

namespace {

constexpr int kWidth = 33, kHeight = 17;

// A disc that moves and fades out at its border, in another colour each frame.
Image<Rgba8> disc(int frame) {
  Image<Rgba8> picture(kWidth, kHeight, Rgba8{0, 0, 0, 0});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const int dx = x - 8 - 8 * frame, dy = y - 8, far = dx * dx + dy * dy;
      if (far < 64)
        picture.at(x, y) = {static_cast<std::uint8_t>(80 * frame), 200, static_cast<std::uint8_t>(4 * x),
                            static_cast<std::uint8_t>(255 - 3 * far)};
    }
  return picture;
}

// What is left of a picture that is packed alone.
Image<Rgba8> packed_alone(const Image<Rgba8>& picture) {
  std::uint8_t* file = nullptr;
  const std::size_t size = WebPEncodeRGBA(picture.data()->data(), kWidth, kHeight, 4 * kWidth, 85, &file);
  Image<Rgba8> out(kWidth, kHeight);
  REQUIRE(WebPDecodeRGBAInto(file, size, out.data()->data(), out.size() * sizeof(Rgba8), 4 * kWidth));
  WebPFree(file);
  return out;
}

}  // namespace

TEST_CASE("animated WebP: a player shows each picture as if it were packed alone, for as long as asked") {
  AnimatedWebp animation(40);
  for (int i = 0; i < 3; ++i) animation.add(disc(i));
  const std::vector<std::byte> bytes = animation.bytes();
  const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  WebPAnimDecoder* player = WebPAnimDecoderNew(&data, nullptr);
  REQUIRE(player);
  WebPAnimInfo info;
  REQUIRE(WebPAnimDecoderGetInfo(player, &info));
  CHECK(info.frame_count == 3);
  CHECK(info.loop_count == 0);
  for (int i = 0; i < 3; ++i) {
    CAPTURE(i);
    std::uint8_t* rgba = nullptr;
    int until_ms = 0;
    REQUIRE(WebPAnimDecoderGetNext(player, &rgba, &until_ms));
    CHECK(until_ms == 40 * (i + 1));
    const Image<Rgba8> alone = packed_alone(disc(i));
    CHECK(std::memcmp(rgba, alone.data(), alone.size() * sizeof(Rgba8)) == 0);
  }
  CHECK_FALSE(WebPAnimDecoderHasMoreFrames(player));
  WebPAnimDecoderDelete(player);
}
