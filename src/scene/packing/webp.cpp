#include "scene/packing/webp.h"

#include <fmt/format.h>
#include <webp/decode.h>
#include <webp/encode.h>

#include <new>

#include "core/error.h"
#include "scene/packing/unpack.h"

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
  WebPDecoderConfig config;
  if (!WebPInitDecoderConfig(&config)) throw Error("webp", "the WebP reader failed to start");
  config.output.colorspace = MODE_RGBA;
  config.output.is_external_memory = 1;
  config.output.u.RGBA = {reinterpret_cast<std::uint8_t*>(out.pixels().data()), static_cast<int>(row_bytes),
                          pixel_bytes};
  const VP8StatusCode status = WebPDecode(data, bytes.size(), &config);
  if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status != VP8_STATUS_OK) refuse("is truncated or damaged");
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
  const WebPEncodingError failure = picture.error_code;
  WebPPictureFree(&picture);
  WebPMemoryWriterClear(&memory);
  if (failure == VP8_ENC_ERROR_OUT_OF_MEMORY || failure == VP8_ENC_ERROR_BITSTREAM_OUT_OF_MEMORY)
    throw std::bad_alloc();
  if (!good)
    throw Error("webp", fmt::format("a picture could not be packed (error {} of libwebp)", int{failure}));
  return out;
}

}  // namespace splatcut
