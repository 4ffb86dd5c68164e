#include "app/cli/cutout_files.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/console/version.h"
#include "core/atomic_file.h"
#include "core/png_file.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/doubts.h"

namespace splatcut {

namespace {

std::vector<std::uint8_t> inverted(const std::vector<std::uint8_t>& labels) {
  std::vector<std::uint8_t> out(labels.size());
  std::ranges::transform(labels, out.begin(), [](std::uint8_t l) { return static_cast<std::uint8_t>(!l); });
  return out;
}

// Colour with straight alpha: the cutout on nothing.
Image<Rgba8> cutout_picture(const Drawer& scene, const Camera& camera, std::span<const std::uint8_t> shown) {
  RasterOptions options;
  options.shown = shown;
  const RasterOutput out = scene.draw(camera, options);
  Image<Rgba8> picture(camera.width_px, camera.height_px);
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const float alpha = out.alpha.pixels()[i];
    const glm::vec3 c = alpha > 0 ? glm::clamp(out.colour.pixels()[i] / alpha, 0.0f, 1.0f) : glm::vec3(0);
    const auto byte = [](float v) { return static_cast<std::uint8_t>(v * 255 + 0.5f); };
    picture.pixels()[i] = {byte(c.r), byte(c.g), byte(c.b), byte(alpha)};
  }
  return picture;
}

// The mask in warm orange over the dimmed picture, with a bright outline.
void tint(const Mask& mask, Image<Rgb8>* picture) {
  const Mask core = eroded(mask, 1);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    Rgb8& p = picture->pixels()[i];
    const Rgb8 orange{255, 140, 30};
    const int share = !mask.pixels()[i] ? 0 : core.pixels()[i] ? 90 : 230;  // of 256
    for (int c = 0; c < 3; ++c)
      p[c] =
          static_cast<std::uint8_t>(share ? (p[c] * (256 - share) + orange[c] * share) >> 8 : p[c] * 3 / 5);
  }
}

Image<Rgb8> tinted_view(const Drawer& scene, const Camera& camera, const Mask& mask) {
  Image<Rgb8> picture = rgb8_from_linear(scene.draw(camera, {}).colour);
  tint(mask, &picture);
  return picture;
}

Image<Rgb8> contact_sheet(const Drawer& scene, const std::vector<ViewReport>& views) {
  constexpr int kGap = 4;
  const int columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(views.size())))));
  const Camera& first = views.front().camera;
  const int width = first.width_px, height = first.height_px;
  const int rows = (static_cast<int>(views.size()) + columns - 1) / columns;
  Image<Rgb8> sheet(columns * (width + kGap) - kGap, rows * (height + kGap) - kGap, Rgb8{24, 24, 24});
  for (std::size_t v = 0; v < views.size(); ++v) {
    const ViewReport& view = views[v];
    const Image<Rgb8> picture = tinted_view(scene, view.camera, view.mask);
    const int x0 = static_cast<int>(v) % columns * (width + kGap),
              y0 = static_cast<int>(v) / columns * (height + kGap);
    for (int y = 0; y < std::min(height, picture.height()); ++y)
      for (int x = 0; x < std::min(width, picture.width()); ++x) {
        Rgb8 p = picture.at(x, y);
        if (!view.used)
          p = {static_cast<std::uint8_t>(p[0] / 3), static_cast<std::uint8_t>(p[1] / 3),
               static_cast<std::uint8_t>(p[2] / 3)};
        sheet.at(x0 + x, y0 + y) = p;
      }
  }
  return sheet;
}

}  // namespace

void write_cutout_picture(const std::filesystem::path& path, const Drawer& scene, const Camera& camera,
                          std::span<const std::uint8_t> shown) {
  write_png(path, cutout_picture(scene, camera, shown));
}

void write_object_pictures(const OutputFolder& folder, const Drawer& scene, const Camera& camera,
                           const CutResult& report, const CutoutObject& object, const PictureNames& names) {
  object.draw(folder.file(names.object), camera);
  const Mask seen = thresholded(render_labels(scene, camera, report.labels), 0.5f);
  write_png(folder.file(names.tint), tinted_view(scene, camera, seen));
  write_png(folder.file(names.masks), contact_sheet(scene, report.views));
}

void write_cutout_pictures(const OutputFolder& folder, const Drawer& scene, const Camera& camera,
                           const CutResult& report, const CutoutObject& object) {
  write_object_pictures(folder, scene, camera, report, object);
  write_cutout_picture(folder.file("rest.png"), scene, camera, inverted(report.labels));
}

void write_labels(const std::filesystem::path& path, const Scene& scene,
                  const std::vector<std::uint8_t>& labels) {
  std::vector<std::uint8_t> in_file_order(scene.file_rows, 0);
  for (std::size_t g = 0; g < labels.size(); ++g) in_file_order[scene.cloud.file_row[g]] = labels[g];
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(in_file_order)));
  file.commit();
}

void write_object_files(const OutputFolder& folder, const Scene& scene, const std::string& name,
                        const CutoutObject& object, const std::vector<std::uint8_t>& labels) {
  object.save(folder.file(name + ".ply"));
  write_labels(folder.file(name + ".labels.u8"), scene, labels);
}

void write_cutout_scenes(const OutputFolder& folder, const Scene& scene,
                         const std::vector<std::uint8_t>& labels, const CutoutObject& object) {
  object.save(folder.file("object.ply"));
  SaveOptions rest;
  rest.may_be_empty = true;
  save_scene(folder.file("rest.ply"), scene, inverted(labels), SceneFormat::kPly, rest);
  write_labels(folder.file("labels.u8"), scene, labels);
}

double peak_rss_mb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

nlohmann::json run_json(const Scene& scene, const nlohmann::json& settings, double total_ms) {
  return {{"version", version()},
          {"settings", settings},
          {"scene",
           {{"gaussians", scene.cloud.size()}, {"file_rows", scene.file_rows}, {"dropped", scene.dropped}}},
          {"total_ms", total_ms},
          {"peak_rss_mb", peak_rss_mb()}};
}

nlohmann::json object_json(const CutResult& report) {
  nlohmann::json views = nlohmann::json::array(), stages = nlohmann::json::array();
  for (const ViewReport& view : report.views) {
    views.push_back({{"used", view.used}, {"confidence", view.confidence}, {"mask_px", count(view.mask)}});
    if (!view.reason.empty()) views.back()["reason"] = view.reason;
  }
  for (const StageTime& stage : report.stages) stages.push_back({{"name", stage.name}, {"ms", stage.ms}});
  const LookedAt enough = looked_at(report.views);
  return {{"object", {{"gaussians", std::ranges::count(report.labels, 1)}}},
          {"views", views},
          {"enough",
           {{"views", enough.views},
            {"pixels", enough.pixels},
            {"gaussians", report.cut.touched},
            {"why", report.why_enough}}},
          {"cut",
           {{"nodes", report.cut.nodes},
            {"arcs", report.cut.arcs},
            {"energy", report.cut.energy},
            {"flow", report.cut.flow}}},
          {"doubts", doubts(report)},
          {"stages", stages}};
}

nlohmann::json report_json(const Scene& scene, const CutResult& report, const nlohmann::json& settings,
                           double total_ms) {
  nlohmann::json json = run_json(scene, settings, total_ms);
  json.update(object_json(report));
  return json;
}

}  // namespace splatcut
