// Files out: work, exports, pictures.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <glm/gtc/constants.hpp>

#include "app/console/output_folder.h"
#include "app/studio/studio.h"
#include "app/studio/words.h"
#include "app/studio/work_file.h"
#include "core/error.h"
#include "core/png_file.h"
#include "scene/raster/rasterizer.h"
#include "segment/superpoints/orbit.h"

namespace splatcut {

namespace {

// Straight alpha over nothing, or colour over the background.
Image<Rgba8> capture(const GaussianCloud& cloud, const Camera& camera, const Flags& visible,
                     const DrawLimits& limits, const glm::vec3& background, bool transparent,
                     const Job& job) {
  RasterOptions options;
  options.near_plane = limits.near_plane;
  options.low_pass_px2 = limits.low_pass_px2;
  const Flags shown = within_far_plane(cloud, camera, visible, limits.far_plane);
  if (shown) options.shown = *shown;
  const RasterOutput out = rasterize(cloud, camera, options, job);
  Image<Rgba8> picture(camera.width_px, camera.height_px);
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const float alpha = out.alpha.pixels()[i];
    const glm::vec3 premultiplied = out.colour.pixels()[i];
    const glm::vec3 c = transparent ? (alpha > 0 ? premultiplied / alpha : glm::vec3(0))
                                    : premultiplied + (1 - alpha) * background;
    const glm::vec3 b = glm::clamp(c, 0.0f, 1.0f) * 255.0f + 0.5f;
    picture.pixels()[i] = {static_cast<std::uint8_t>(b.r), static_cast<std::uint8_t>(b.g),
                           static_cast<std::uint8_t>(b.b),
                           transparent ? static_cast<std::uint8_t>(alpha * 255 + 0.5f) : std::uint8_t{255}};
  }
  return picture;
}

std::string described(const std::filesystem::path& work) {
  const auto written = std::chrono::file_clock::to_sys(std::filesystem::last_write_time(work));
  const std::time_t seconds = std::chrono::system_clock::to_time_t(
      std::chrono::time_point_cast<std::chrono::system_clock::duration>(written));
  const std::string when = fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(seconds));
  try {
    return fmt::format("{}, {}", read_work_file(work).scene.filename().string(), when);
  } catch (const Error&) {
    return when;  // what is wrong with it is said when it is restored
  }
}

}  // namespace

void Studio::find_autosave() {
  if (options_.state_folder.empty()) return;
  for (const char* name : {kAutosaveBefore, kAutosave})
    if (std::filesystem::exists(options_.state_folder / name)) restorable_ = options_.state_folder / name;
  if (!restorable_.empty()) restorable_says_ = described(restorable_);
}

void Studio::perform(const SaveWork& c) {
  require_scene();
  std::filesystem::path path = c.path;
  if (!is_work_file(path)) path += ".splatcut.json";
  tasks_.submit(TaskKind::kSave, [this, path, serial = document_serial_, document = document(),
                                  view = camera_.pose(), scene = scene_](const Job& job) {
    job.progress("saving", 0);
    write_work_file(path, *scene->scene, scene->hash, document, view);
    tasks_.post([this, path, serial, scene] {
      say(Message::Kind::kDone, "Work saved to " + path.string());
      if (scene != scene_) return;
      work_path_ = path;
      saved_serial_ = serial;
    });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

void Studio::leave() {
  if (options_.state_folder.empty() || unsaved()) return;
  tasks_.cancel(TaskKind::kAutosave);
  std::error_code ignored;
  if (restorable_ != options_.state_folder / kAutosave)
    std::filesystem::remove(options_.state_folder / kAutosave, ignored);
}

void Studio::perform(const RestoreAutosave&) {
  if (restorable_.empty()) throw Error("restore", "there is no autosaved work");
  say(Message::Kind::kInfo, "Restoring the work of last time: " + restorable_says_);
  perform(OpenScene{restorable_});  // once it is open, it is offered no longer
}

void Studio::perform(const DropAutosave&) {
  if (restorable_.empty()) throw Error("restore", "there is no autosaved work");
  std::error_code ignored;
  std::filesystem::remove(std::exchange(restorable_, {}), ignored);
  say(Message::Kind::kInfo, "The work of last time is gone");
}

void Studio::perform(const Export& c) {
  require_scene();
  const TaskThread::Order export_order(TaskKind::kExport,
                                       [this] { ui_requests_.push_back(UiRequest::kExportFailed); });
  tasks_.submit(export_order, [this, request = c.request, document = document(), object = document().active,
                               scene = scene_](const Job& job) {
    job.progress("exporting", 0);
    const ExportReport report = run_export(*scene->scene, document, object, request);
    std::string text = fmt::format("{} Gaussians, {} saved to {}", grouped(report.gaussians),
                                   human_bytes(report.bytes), request.path.string());
    if (!report.loss.empty()) text += ". Lost: " + report.loss;
    tasks_.post([this, text] { say(Message::Kind::kDone, text); });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

void Studio::perform(const SaveSnapshot& c) {
  require_scene();
  const Camera camera = viewport_camera();
  tasks_.submit(TaskKind::kExport, [this, c, camera, visible = shown(0), limits = draw_limits(),
                                    background = document().background, scene = scene_](const Job& job) {
    job.progress("drawing", 0);
    const Image<Rgba8> picture =
        capture(*scene->cloud, camera, visible, limits, background, c.transparent, job);
    if (job.cancelled()) return;
    write_png(c.path, picture);
    tasks_.post([this, c] { say(Message::Kind::kDone, "Picture saved to " + c.path.string()); });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

void Studio::perform(const SaveTurntable& c) {
  require_scene();
  constexpr int kMostFrames = 10000, kMostPixels = 8192;
  if (c.frames < 2 || c.frames > kMostFrames)
    throw Error("turntable", fmt::format("{} frames are too {}", c.frames, c.frames < 2 ? "few" : "many"));
  if (c.width_px < 0 || c.height_px < 0 || c.width_px > kMostPixels || c.height_px > kMostPixels)
    throw Error("turntable",
                fmt::format("a picture of {} x {} pixels is impossible", c.width_px, c.height_px));
  const ObjectItem* object = document().active_object();
  if (!object || gaussians_of(object->id) == 0)
    throw Error("turntable", "there is no object to turn", "Click an object first");
  const std::vector<std::uint8_t> own = labels(object->id);
  const ObjectExtent extent = object_extent(*scene_->cloud, own);
  const Camera front = viewport_camera();
  tasks_.submit(TaskKind::kExport, [this, c, extent, front, visible = make_flags(own), limits = draw_limits(),
                                    up = document().up_world, scene = scene_](const Job& job) {
    OutputFolder folder(c.folder, true);
    DrawLimits all = limits;  // the far plane is that of another view
    all.far_plane = DrawLimits{}.far_plane;
    // The camera goes round at its own elevation, from where the user stands.
    const glm::vec3 back = front.centre_world() - extent.centre_world;
    const glm::vec3 offset = glm::normalize(back) * (extent.radius * 2 * OrbitOptions{}.distance_sizes);
    const float fov_y = 2 * std::atan(0.5f * static_cast<float>(front.height_px) / front.fy_px);
    const int width = c.width_px > 0 ? c.width_px : front.width_px;
    const int height = c.height_px > 0 ? c.height_px : front.height_px;
    for (int i = 0; i < c.frames && !job.cancelled(); ++i) {
      job.progress("turntable", static_cast<double>(i) / c.frames);
      const float angle = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(c.frames);
      const Camera camera = look_at(extent.centre_world + glm::angleAxis(angle, up) * offset,
                                    extent.centre_world, up, fov_y, width, height);
      write_png(folder.file(fmt::format("frame_{:04}.png", i)),
                capture(*scene->cloud, camera, visible, all, glm::vec3(0), true, job));
    }
    if (job.cancelled()) return;
    folder.commit();
    tasks_.post([this, c] {
      say(Message::Kind::kDone, fmt::format("{} frames saved to {}", c.frames, c.folder.string()));
    });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

}  // namespace splatcut
