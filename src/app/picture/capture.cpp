#include "app/picture/capture.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "app/console/output_folder.h"
#include "app/console/run_program.h"
#include "app/picture/animated_webp.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/mapped_file.h"
#include "core/png_file.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

using Draw = std::function<Image<Rgba8>(std::size_t frame)>;

// Holds the pictures that a video is made of; goes with them.
class PictureFolder {
 public:
  PictureFolder() {
    std::string name = (fs::temp_directory_path() / "splatcut-turntable-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw Error(name, "no folder for the pictures can be made there");
    path_ = name;
  }
  ~PictureFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PictureFolder(const PictureFolder&) = delete;
  PictureFolder& operator=(const PictureFolder&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

std::string frame_name(std::size_t number) {
  return fmt::format("frame_{:04}.png", number);
}

bool write_pictures(const TurntableOptions& options, std::size_t frames, const Draw& draw, const Job& job) {
  OutputFolder folder(options.path, true);
  for (std::size_t i = 0; i < frames && !job.cancelled(); ++i) write_png(folder.file(frame_name(i)), draw(i));
  if (job.cancelled()) return false;
  folder.commit();
  return true;
}

bool write_animation(const TurntableOptions& options, std::size_t frames, const Draw& draw, const Job& job) {
  const auto frame_ms = static_cast<int>(std::lround(1000 * options.turn_s / static_cast<float>(frames)));
  AnimatedWebp animation(std::max(1, frame_ms));
  for (std::size_t i = 0; i < frames && !job.cancelled(); ++i) animation.add(draw(i));
  if (job.cancelled()) return false;
  AtomicFile out(options.path);
  out.write(animation.bytes());
  out.commit();
  return true;
}

void check_ffmpeg(const ProgramEnd& end) {
  if (end.start_error != 0) throw Error("ffmpeg", "is not installed", "Install it, or save an animated WebP");
  if (end.signal != 0 || end.exit_code != 0)
    throw Error("ffmpeg", "could not make the video", "What it printed says why; or save an animated WebP");
}

bool write_video(const TurntableOptions& options, std::size_t frames, const Draw& draw, const Job& job) {
  const PictureFolder folder;
  for (std::size_t i = 0; i < frames && !job.cancelled(); ++i) write_png(folder / frame_name(i), draw(i));
  if (job.cancelled()) return false;
  const fs::path video = folder / "turntable.mp4";
  const ProgramEnd end =
      run_program({"ffmpeg", "-loglevel", "error", "-y", "-framerate",
                   fmt::format("{:.4f}", static_cast<float>(frames) / options.turn_s), "-i",
                   (folder / "frame_%04d.png").string(), "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt",
                   "yuv420p", "-movflags", "+faststart", video.string()},
                  job);
  if (job.cancelled()) return false;
  check_ffmpeg(end);
  const MappedFile made(video);
  AtomicFile out(options.path);
  out.write(made.bytes());
  out.commit();
  return true;
}

}  // namespace

Image<Rgba8> capture(const GaussianCloud& cloud, const Camera& camera, const Flags& visible,
                     const DrawLimits& limits, const glm::vec3& background, bool transparent,
                     const Job& job) {
  RasterOptions options;
  options.near_plane = limits.near_plane;
  options.low_pass_px2 = limits.low_pass_px2;
  const Flags shown = within_far_plane(cloud, camera, visible, limits.far_plane);
  if (shown) options.shown = *shown;
  RasterOutput out = rasterize(cloud, camera, options, job);
  if (!transparent)
    for (std::size_t i = 0; i < out.alpha.size(); ++i) {
      float& alpha = out.alpha.data()[i];
      out.colour.data()[i] += (1 - alpha) * background;
      alpha = 1;
    }
  return rgba8_from_premultiplied(out.colour, out.alpha);
}

bool save_turntable(const GaussianCloud& cloud, const std::vector<Camera>& cameras, const Flags& visible,
                    const DrawLimits& limits, const TurntableOptions& options, const Job& job) {
  const bool transparent = options.as != TurntableAs::kVideo;
  const Draw draw = [&](std::size_t i) {
    job.progress("turntable", static_cast<double>(i) / static_cast<double>(cameras.size()));
    return capture(cloud, cameras[i], visible, limits, options.background, transparent, job);
  };
  switch (options.as) {
    case TurntableAs::kPictures:
      return write_pictures(options, cameras.size(), draw, job);
    case TurntableAs::kWebp:
      return write_animation(options, cameras.size(), draw, job);
    case TurntableAs::kVideo:
      break;
  }
  return write_video(options, cameras.size(), draw, job);
}

}  // namespace splatcut
