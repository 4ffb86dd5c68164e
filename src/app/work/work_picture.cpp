#include "app/work/work_picture.h"
#include "app/work/work_file.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <string>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/picture_file.h"
#include "core/png_file.h"

namespace splatcut {

namespace {

constexpr int kSamples = 4;  // along each side of a pixel

int place_of(int sample, int samples, int size) {
  const std::int64_t place = (2 * std::int64_t{sample} + 1) * size / (2 * std::int64_t{samples});
  return static_cast<int>(std::min<std::int64_t>(place, size - 1));
}

}  // namespace

Image<Rgb8> work_picture(const Image<Rgba8>& view) {
  if (view.empty()) return {};
  const int width = std::min(kWorkPictureWidthPx, view.width());
  const int height = std::clamp(static_cast<int>(std::int64_t{view.height()} * width / view.width()), 1,
                                2 * kWorkPictureWidthPx);
  Image<Rgb8> small(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      int sum[3] = {};
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const Rgba8& from = view.at(place_of(kSamples * x + s % kSamples, kSamples * width, view.width()),
                                    place_of(kSamples * y + s / kSamples, kSamples * height, view.height()));
        for (std::size_t c = 0; c < 3; ++c) sum[c] += from[c];
      }
      for (std::size_t c = 0; c < 3; ++c)
        small.at(x, y)[c] = static_cast<std::uint8_t>(sum[c] / (kSamples * kSamples));
    }
  return small;
}

std::filesystem::path picture_of_work(const std::filesystem::path& work) {
  std::string path = work.string();
  if (path.ends_with(kWorkEnding)) path.resize(path.size() - kWorkEnding.size());
  return path + ".png";
}

// It need not outlive a power cut: to wait for the disk would take longer than all the rest.
void write_work_picture(const std::filesystem::path& work, const Image<Rgb8>& picture) {
  try {
    if (picture.empty())
      std::filesystem::remove(picture_of_work(work));
    else
      write_text_file(picture_of_work(work), png_bytes(picture), PowerCut::kMayLeaveNone);
  } catch (const std::exception&) {  // the work itself is written
  }
}

Image<Rgba8> read_work_picture(const std::filesystem::path& work) {
  constexpr int kMostSide = 2 * kWorkPictureWidthPx;  // what is larger is none of ours
  try {
    const std::filesystem::path path = picture_of_work(work);
    if (!std::filesystem::is_regular_file(path)) return {};
    const auto size = picture_size(path);
    if (!size || size->x < 1 || size->y < 1 || size->x > kMostSide || size->y > kMostSide) return {};
    return read_picture(path).pixels;
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace splatcut
