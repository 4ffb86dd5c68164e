#include "app/console/mask_file.h"

#include <algorithm>
#include <functional>

#include "core/error.h"
#include "segment/masks/seeds.h"

namespace splatcut {

namespace {

constexpr int kHalf = 128;

int brightest_of(const Rgba8& p) {
  return std::max({p[0], p[1], p[2]});
}
bool is_grey(const Rgba8& p, int within) {
  return brightest_of(p) - std::min({p[0], p[1], p[2]}) <= within;
}

template <class Pixel, class Test>
Mask where(const Image<Pixel>& image, const Test& is_object) {
  Mask mask(image.width(), image.height());
  std::ranges::transform(image.pixels(), mask.pixels().begin(), [&](const Pixel& p) {
    return static_cast<std::uint8_t>(is_object(p) ? kMaskObject : 0);
  });
  return mask;
}

// Whether most of what is darker than `half` and not black lies in the midst of areas of one level: numbers
// of objects do, smoothed borders of white do not.
template <class Pixel>
bool has_dark_areas(const Image<Pixel>& grey, int half) {
  std::size_t dark = 0, within = 0;
  for (int y = 0; y < grey.height(); ++y)
    for (int x = 0; x < grey.width(); ++x) {
      const Pixel level = grey.at(x, y);
      if (level == 0 || level >= half) continue;
      ++dark;
      bool same = true;
      for (int v = std::max(0, y - 1); v <= std::min(y + 1, grey.height() - 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(x + 1, grey.width() - 1); ++u)
          same = same && grey.at(u, v) == level;
      within += same;
    }
  return 2 * within > dark;
}

// half: of what white would be. Numbers of objects, which reach it where there are many, never reach white.
template <class Pixel>
ReadMask mask_of_grey(const Image<Pixel>& grey, int half, int least) {
  const int brightest = *std::ranges::max_element(grey.pixels());
  if (brightest < least) return {Mask(grey.width(), grey.height()), ""};
  const bool numbers = least == 1 && brightest < 2 * half - 1 && has_dark_areas(grey, half);
  if (brightest >= half && !numbers) return {where(grey, [&](Pixel p) { return p >= half; }), "white"};
  return {where(grey, [&](Pixel p) { return p >= least; }), "numbers, 0 is the rest"};
}

// Whether both object and rest are there: smoothed borders alone, or a picture that is all opaque, show
// nothing.
bool has_both(const Mask& mask) {
  return std::ranges::adjacent_find(mask.pixels(), std::not_equal_to()) != mask.pixels().end();
}

// Of the picture's brightness or its alpha.
template <class Level>
Image<std::uint8_t> levels_of(const Image<Rgba8>& pixels, const Level& level) {
  Image<std::uint8_t> levels(pixels.width(), pixels.height());
  std::ranges::transform(pixels.pixels(), levels.pixels().begin(),
                         [&](const Rgba8& p) { return static_cast<std::uint8_t>(level(p)); });
  return levels;
}

ReadMask mask_of_colours(const Image<Rgba8>& pixels, int least, const std::string& where_it_is) {
  Mask mask = where(pixels, [&](const Rgba8& p) { return brightest_of(p) >= least; });
  if (std::ranges::all_of(mask.pixels(), [](std::uint8_t m) { return m == kMaskObject; }))
    throw Error(where_it_is, "is a photograph, not a mask: nothing in it is black",
                "Give a picture that is black where the object is not");
  return {std::move(mask), "any colour on black"};
}

}  // namespace

ReadMask mask_of(const Picture& picture, const std::string& where_it_is) {
  const Image<Rgba8>& pixels = picture.pixels;
  if (ReadMask alpha = mask_of_grey(levels_of(pixels, [](const Rgba8& p) { return p[3]; }), kHalf, 1);
      has_both(alpha.mask))
    return {std::move(alpha.mask), "alpha"};
  constexpr int kWide = 1 << 8, kWideHalf = 1 << 15;
  if (!picture.grey16.pixels().empty()) {
    const bool wide = *std::ranges::max_element(picture.grey16.pixels()) >= kWide;
    return mask_of_grey(picture.grey16, wide ? kWideHalf : kHalf, 1);
  }
  // JPEG leaves traces of colour in grey, and of light in black.
  constexpr int kTraces = 24, kLossyLeast = 64;
  const int within = picture.lossy ? kTraces : 0;
  const bool grey = std::ranges::all_of(pixels.pixels(), [&](const Rgba8& p) { return is_grey(p, within); });
  if (!grey && !picture.indices.pixels().empty())
    return {where(picture.indices, [](std::uint8_t index) { return index > 0; }), "palette, index > 0"};
  constexpr int kDarkestColour = 32;  // the least of the usual palettes of ids
  const Image<std::uint8_t> levels = levels_of(pixels, brightest_of);
  const bool dark = *std::ranges::max_element(levels.pixels()) < kDarkestColour;  // ids in one channel
  const int least = picture.lossy ? kLossyLeast : dark ? 1 : kDarkestColour;
  if (!grey) return mask_of_colours(pixels, least, where_it_is);
  return mask_of_grey(levels, kHalf, picture.lossy ? kLossyLeast : 1);
}

ReadMask read_mask(const std::filesystem::path& path) {
  return mask_of(read_picture(path), path.string());
}

}  // namespace splatcut
