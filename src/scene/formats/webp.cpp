#include "scene/formats/webp.h"

#include <fmt/format.h>
#include <webp/decode.h>
#include <webp/encode.h>

#include "scene/error.h"
#include "scene/formats/decode.h"

namespace splatcut {

Image<Rgba8> read_webp(const std::filesystem::path& file, std::string_view picture,
                       std::span<const std::byte> bytes, std::size_t file_bytes) {
  const auto refuse = [&](const char* what) {
    throw Error(file.string(), fmt::format("the picture {} {}", picture, what));
  };
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  int width = 0, height = 0;
  if (!WebPGetInfo(data, bytes.size(), &width, &height)) refuse("is no WebP");
  const std::size_t row_bytes = static_cast<std::size_t>(width) * sizeof(Rgba8);
  const std::size_t pixel_bytes = row_bytes * static_cast<std::size_t>(height);
  check_expansion(file, file_bytes, pixel_bytes);
  Image<Rgba8> out(width, height);
  if (!WebPDecodeRGBAInto(data, bytes.size(), reinterpret_cast<std::uint8_t*>(out.pixels().data()),
                          pixel_bytes, static_cast<int>(row_bytes)))
    refuse("is truncated or damaged");
  return out;
}

std::vector<std::byte> write_webp(const Image<Rgba8>& image) {
  constexpr int kLevel = 4;  // of 9: beyond it files shrink by a hundredth and the time doubles
  WebPConfig config;
  WebPPicture picture;
  if (!WebPConfigInit(&config) || !WebPPictureInit(&picture) || !WebPConfigLosslessPreset(&config, kLevel))
    throw Error("webp", "the WebP writer failed to start");
  config.exact = 1;
  picture.use_argb = 1;
  picture.width = image.width();
  picture.height = image.height();
  WebPMemoryWriter memory;
  WebPMemoryWriterInit(&memory);
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &memory;
  const auto* pixels = reinterpret_cast<const std::uint8_t*>(image.pixels().data());
  const bool good =
      WebPPictureImportRGBA(&picture, pixels, image.width() * static_cast<int>(sizeof(Rgba8))) &&
      WebPEncode(&config, &picture);
  const std::span<const std::byte> written(reinterpret_cast<const std::byte*>(memory.mem), memory.size);
  std::vector<std::byte> out(written.begin(), written.end());
  const int failure = picture.error_code;
  WebPPictureFree(&picture);
  WebPMemoryWriterClear(&memory);
  if (!good) throw Error("webp", fmt::format("a picture could not be packed (error {} of libwebp)", failure));
  return out;
}

}  // namespace splatcut
