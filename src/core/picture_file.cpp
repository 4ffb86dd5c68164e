#include "core/picture_file.h"

#include <fmt/format.h>
#include <png.h>
#include <webp/decode.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <jpeglib.h>  // behind <cstdio>, whose FILE it takes for granted

#include "core/error.h"
#include "core/mapped_file.h"
#include "core/stand_in.h"

namespace splatcut {

namespace {

constexpr int kMostSide = 1 << 15;
constexpr std::uint64_t kMostPerByte = 8 * 1032;  // pixels, a bit each, as far as deflate can shrink them

const std::uint8_t* begin_of(std::string_view bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

bool is_png(std::string_view bytes) {
  return bytes.starts_with("\x89PNG");
}

[[noreturn]] void refuse_damaged(const std::filesystem::path& path, std::string_view why) {
  throw Error(path.string(), fmt::format("is damaged ({})", why));
}

void check_sides(const std::filesystem::path& path, std::uint64_t width, std::uint64_t height,
                 std::uint64_t bytes) {
  if (width > kMostSide || height > kMostSide)
    throw Error(path.string(),
                fmt::format("the picture is {} x {} pixels, more than {} a side", width, height, kMostSide));
  if (width * height > kMostPerByte * bytes)
    throw Error(path.string(), fmt::format("is damaged: {} x {} pixels in {} bytes", width, height, bytes));
}

// The PNG without what says how its numbers become light: libpng would convert 16 bits by it. What is no
// sequence of whole chunks is left as it is, for the library to refuse.
std::string without_light(std::string_view png) {
  constexpr std::size_t kMark = 8, kLength = 4, kName = 4, kChecksum = 4;
  constexpr std::array<std::string_view, 4> kOfLight = {"gAMA", "cHRM", "sRGB", "iCCP"};
  std::string kept(png.substr(0, kMark));
  std::size_t at = kMark;
  while (at + kLength + kName <= png.size()) {
    std::uint64_t length = 0;
    for (std::size_t i = 0; i < kLength; ++i) length = length << 8 | static_cast<std::uint8_t>(png[at + i]);
    const std::uint64_t whole = kLength + kName + length + kChecksum;
    if (whole > png.size() - at) break;
    if (std::ranges::find(kOfLight, png.substr(at + kLength, kName)) == kOfLight.end())
      kept += png.substr(at, whole);
    at += whole;
  }
  return kept += png.substr(at);
}

// Of a PNG, without its pixels.
png_image described_png(const std::filesystem::path& path, std::string_view bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) refuse_damaged(path, png.message);
  png_image_free(&png);
  check_sides(path, png.width, png.height, bytes.size());
  return png;
}

// One reading of a PNG in a format of libpng's; without alpha on black. colours: of the palette, where
// indices are read.
void read_png_as(const std::filesystem::path& path, std::string_view bytes, png_uint_32 format, void* pixels,
                 void* colours = nullptr) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) refuse_damaged(path, png.message);
  png.format = format;
  const png_color black{0, 0, 0};
  if (!png_image_finish_read(&png, &black, pixels, 0, colours)) refuse_damaged(path, png.message);
}

Picture read_any_png(const std::filesystem::path& path, std::string_view bytes) {
  const png_image png = described_png(path, bytes);
  const png_uint_32 format = png.format;
  const auto width = static_cast<int>(png.width), height = static_cast<int>(png.height);
  Picture picture;
  picture.pixels = Image<Rgba8>(width, height);
  read_png_as(path, bytes, PNG_FORMAT_RGBA, picture.pixels.data());
  if (format & PNG_FORMAT_FLAG_COLORMAP) {
    std::vector<Rgba8> colours(256);
    picture.indices = Image<std::uint8_t>(width, height);
    read_png_as(path, bytes, PNG_FORMAT_RGBA_COLORMAP, picture.indices.data(), colours.data());
  } else if ((format & PNG_FORMAT_FLAG_LINEAR) &&
             !(format & (PNG_FORMAT_FLAG_COLOR | PNG_FORMAT_FLAG_ALPHA))) {
    picture.grey16 = Image<std::uint16_t>(width, height);
    read_png_as(path, without_light(bytes), PNG_FORMAT_LINEAR_Y, picture.grey16.data());
  }
  return picture;
}

template <class Pixel>
Image<Pixel> read_png(const std::filesystem::path& path, png_uint_32 format) {
  const std::string bytes = text_of_file(path);
  if (!is_png(bytes)) throw Error(path.string(), "is no PNG");
  const png_image png = described_png(path, bytes);
  Image<Pixel> image(static_cast<int>(png.width), static_cast<int>(png.height));
  read_png_as(path, bytes, format, image.data());
  return image;
}

struct JpegFailure {
  jpeg_error_mgr manager;  // first: the library hands it back
  std::jmp_buf back;
  char message[JMSG_LENGTH_MAX];
  bool is_cmyk;
};

[[noreturn]] void on_jpeg_failure(j_common_ptr info) {
  auto* failure = reinterpret_cast<JpegFailure*>(info->err);
  info->err->format_message(info, failure->message);
  std::longjmp(failure->back, 1);
}

void on_jpeg_warning(j_common_ptr info, int level) {
  if (level < 0) on_jpeg_failure(info);  // a part of the picture is missing
}

// Rows of rgb into `pixels`, which has room. False, with the library's words, for a damaged file. Nothing
// with a destructor lives here: the library leaves by longjmp.
bool decode_jpeg(std::string_view bytes, JpegFailure* failure, Rgba8* pixels, int width, int height,
                 std::uint8_t* row) {
  jpeg_decompress_struct info;
  info.err = jpeg_std_error(&failure->manager);
  failure->manager.error_exit = on_jpeg_failure;
  failure->manager.emit_message = on_jpeg_warning;
  if (setjmp(failure->back)) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, begin_of(bytes), bytes.size());
  jpeg_read_header(&info, TRUE);
  failure->is_cmyk = info.jpeg_color_space == JCS_CMYK || info.jpeg_color_space == JCS_YCCK;
  info.out_color_space = JCS_RGB;  // where they are CMYK, the library refuses
  jpeg_start_decompress(&info);
  const bool as_said =
      static_cast<int>(info.output_width) == width && static_cast<int>(info.output_height) == height;
  while (as_said && info.output_scanline < info.output_height) {
    Rgba8* to = pixels + static_cast<std::size_t>(info.output_scanline) * static_cast<std::size_t>(width);
    jpeg_read_scanlines(&info, &row, 1);
    for (int x = 0; x < width; ++x) to[x] = {row[3 * x], row[3 * x + 1], row[3 * x + 2], 255};
  }
  jpeg_destroy_decompress(&info);
  return as_said;
}

// Of the frame header, which every JPEG has before its pixels.
std::optional<glm::ivec2> jpeg_size(std::string_view bytes) {
  const std::uint8_t* b = begin_of(bytes);
  constexpr std::uint8_t kMark = 0xff, kFirstFrame = 0xc0, kLastFrame = 0xcf;
  for (std::size_t at = 2; at + 9 < bytes.size();) {
    if (b[at] != kMark) return {};
    const std::uint8_t kind = b[at + 1];
    const bool tables = kind == 0xc4 || kind == 0xc8 || kind == 0xcc;
    if (kind >= kFirstFrame && kind <= kLastFrame && !tables)
      return glm::ivec2(b[at + 7] << 8 | b[at + 8], b[at + 5] << 8 | b[at + 6]);
    at += kind == kMark ? 1 : 2 + (static_cast<std::size_t>(b[at + 2]) << 8 | b[at + 3]);
  }
  return {};
}

Picture read_jpeg(const std::filesystem::path& path, std::string_view bytes) {
  const std::optional<glm::ivec2> size = jpeg_size(bytes);
  if (!size || size->x <= 0 || size->y <= 0) refuse_damaged(path, "it does not say its size");
  check_sides(path, static_cast<std::uint64_t>(size->x), static_cast<std::uint64_t>(size->y), bytes.size());
  Picture picture;
  picture.pixels = Image<Rgba8>(size->x, size->y);
  picture.lossy = true;
  std::vector<std::uint8_t> row(3 * static_cast<std::size_t>(size->x));
  JpegFailure failure{};
  if (decode_jpeg(bytes, &failure, picture.pixels.data(), size->x, size->y, row.data())) return picture;
  if (failure.is_cmyk)
    throw Error(path.string(), "has the colours of print (CMYK), which are not read",
                "Save it with RGB colours, or as PNG");
  refuse_damaged(path, *failure.message ? failure.message : "its size is another than it says");
}

Picture read_any_webp(const std::filesystem::path& path, std::string_view bytes) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(begin_of(bytes), bytes.size(), &features) != VP8_STATUS_OK)
    refuse_damaged(path, "it begins as a WebP");
  check_sides(path, static_cast<std::uint64_t>(features.width), static_cast<std::uint64_t>(features.height),
              bytes.size());
  Picture picture;
  constexpr int kLossyFormat = 1;
  picture.lossy = features.format == kLossyFormat;
  picture.pixels = Image<Rgba8>(features.width, features.height);
  const auto row_bytes = features.width * static_cast<int>(sizeof(Rgba8));
  if (!WebPDecodeRGBAInto(begin_of(bytes), bytes.size(),
                          reinterpret_cast<std::uint8_t*>(picture.pixels.data()),
                          picture.pixels.size() * sizeof(Rgba8), row_bytes))
    refuse_damaged(path, "its pixels are cut short");
  return picture;
}

bool is_jpeg(std::string_view bytes) {
  return bytes.starts_with("\xff\xd8\xff");
}

}  // namespace

Image<Rgb8> read_png_rgb(const std::filesystem::path& path) {
  return read_png<Rgb8>(path, PNG_FORMAT_RGB);
}

Image<std::uint8_t> read_png_grey(const std::filesystem::path& path) {
  return read_png<std::uint8_t>(path, PNG_FORMAT_GRAY);
}

ExactPng read_exact_png(const std::filesystem::path& path) {
  const std::string bytes = text_of_file(path);
  if (!is_png(bytes)) throw Error(path.string(), "is no PNG");
  const png_image png = described_png(path, bytes);
  const auto width = static_cast<int>(png.width), height = static_cast<int>(png.height);
  ExactPng exact;
  if (png.format & PNG_FORMAT_FLAG_LINEAR) {
    exact.rgba16 = Image<Rgba16>(width, height);
    read_png_as(path, without_light(bytes), PNG_FORMAT_LINEAR_RGB_ALPHA, exact.rgba16.data());
  } else if (png.format & PNG_FORMAT_FLAG_ALPHA) {
    Image<Rgba8> straight(width, height);
    read_png_as(path, bytes, PNG_FORMAT_RGBA, straight.data());
    exact.rgba16 = Image<Rgba16>(width, height);
    std::ranges::transform(straight.pixels(), exact.rgba16.pixels().begin(), [](const Rgba8& p) {
      const auto times_alpha = [&](std::uint8_t v) {
        return static_cast<std::uint16_t>((257u * v * p[3] + 127) / 255);
      };
      return Rgba16{times_alpha(p[0]), times_alpha(p[1]), times_alpha(p[2]),
                    static_cast<std::uint16_t>(257u * p[3])};
    });
  } else {
    exact.rgb8 = Image<Rgb8>(width, height);
    read_png_as(path, bytes, PNG_FORMAT_RGB, exact.rgb8.data());
  }
  return exact;
}

Picture read_picture(const std::filesystem::path& path) {
  const std::string bytes = text_of_file(path);
  if (is_png(bytes)) return read_any_png(path, bytes);
  if (is_jpeg(bytes)) return read_jpeg(path, bytes);
  constexpr std::string_view kWebpMark = "WEBPVP8";  // behind RIFF and a size
  if (bytes.starts_with("RIFF") && std::string_view(bytes).substr(0, 15).ends_with(kWebpMark))
    return read_any_webp(path, bytes);
  refuse_stand_in(path, bytes);
  if (bytes.empty()) throw Error(path.string(), "the file is empty (0 bytes)");
  throw Error(path.string(), "is neither PNG nor JPEG nor WebP");
}

std::optional<glm::ivec2> picture_size(const std::filesystem::path& path) {
  const MappedFile file(path);
  const std::string_view bytes = file.text();
  if (is_jpeg(bytes)) return jpeg_size(bytes);
  constexpr std::size_t kSizeAt = 16, kSizeEnd = 24;
  if (!is_png(bytes) || bytes.size() < kSizeEnd) return {};
  const std::uint8_t* b = begin_of(bytes) + kSizeAt;
  return glm::ivec2(b[0] << 24 | b[1] << 16 | b[2] << 8 | b[3], b[4] << 24 | b[5] << 16 | b[6] << 8 | b[7]);
}

}  // namespace splatcut
