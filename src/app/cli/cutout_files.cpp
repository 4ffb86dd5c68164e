#include "app/cli/cutout_files.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/document/export_plan.h"
#include "core/atomic_file.h"
#include "core/png_file.h"
#include "core/stage_clock.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

// The cutout on nothing.
void write_cutout_picture(const std::filesystem::path& path, const Drawer& scene, const Camera& camera,
                          std::span<const std::uint8_t> shown) {
  RasterOptions options;
  options.shown = shown;
  const RasterOutput out = scene.draw(camera, options);
  write_png(path, rgba8_from_premultiplied(out.colour, out.alpha));
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

// A byte for each row of the file, 0 for rows that the cloud lacks.
void write_labels(const std::filesystem::path& path, const Scene& scene,
                  const std::vector<std::uint8_t>& labels) {
  std::vector<std::uint8_t> in_file_order(scene.file_rows, 0);
  for (std::size_t g = 0; g < labels.size(); ++g) in_file_order[scene.cloud.file_row[g]] = labels[g];
  AtomicFile file(path);
  file.write(std::as_bytes(std::span(in_file_order)));
  file.commit();
}

}  // namespace

void EdgeOptions::add_to(CLI::App& command) {
  command
      .add_option("--edges", edges,
                  "clean: the object without what the scene around it had hidden, where its views agree; "
                  "keep: its rows as they are")
      ->check(CLI::IsMember({"clean", "keep"}))
      ->capture_default_str();
}

nlohmann::json EdgesReport::json() const {
  nlohmann::json json = {{"edges", clean && clean->cleaned ? "clean" : "keep"}, {"gaussians", gaussians}};
  if (!clean) return json;
  json.update({{"views", clean->views}, {"agreed", clean->agreed}, {"ms", ms}});
  if (!clean->cleaned) {
    json["why_kept"] = clean->reason;
    return json;
  }
  if (clean->uncut) json["uncut"] = true;
  json.update({{"left", clean->left},
               {"split", clean->split},
               {"made_solid", clean->made_solid},
               {"recoloured", clean->recoloured}});
  return json;
}

ObjectFiles files_of_object(const std::string& name) {
  return {name + ".ply", name + ".labels.u8", name + ".png", name + ".tint.png", name + ".masks.png"};
}

ObjectFiles files_of_only_object() {
  return {"object.ply", "", "object.png", "tint.png", "masks.png"};
}

EdgesReport write_object(const CutoutFolder& to, const ObjectFiles& files,
                         const std::vector<std::uint8_t>& labels, const ObjectView* shown, const Job& job) {
  EdgesReport report;
  std::optional<CleanObject> clean;
  if (to.edges.clean()) {
    const auto start = std::chrono::steady_clock::now();
    clean = clean_object({to.drawer(), labels, to.up_world, to.cameras}, {}, job);
    report.ms = ms_since(start);
    report.clean = clean->report;
    if (!clean->report.cleaned) clean.reset();
  }
  if (job.cancelled()) return report;
  report.gaussians = save_gaussians(to.folder.file(files.scene), to.scene, labels,
                                    clean ? &clean->cloud : nullptr, SceneFormat::kPly)
                         .gaussians;
  if (!files.labels.empty()) write_labels(to.folder.file(files.labels), to.scene, labels);
  if (!shown) return report;
  write_cutout_picture(to.folder.file(files.picture), clean ? Drawer(clean->cloud) : to.drawer(),
                       shown->camera, clean ? std::span<const std::uint8_t>() : labels);
  const Mask seen = thresholded(render_labels(to.drawer(), shown->camera, labels), 0.5f);
  write_png(to.folder.file(files.tint), tinted_view(to.drawer(), shown->camera, seen));
  write_png(to.folder.file(files.masks), contact_sheet(to.drawer(), shown->views));
  return report;
}

std::size_t write_rest(const CutoutFolder& to, const std::vector<std::uint8_t>& owner, const Camera& camera) {
  std::vector<std::uint8_t> rest(owner.size());
  std::ranges::transform(owner, rest.begin(),
                         [](std::uint8_t o) { return static_cast<std::uint8_t>(o == 0); });
  const SaveReport saved =
      save_scene(to.folder.file("rest.ply"), to.scene, rest, SceneFormat::kPly, {.may_be_empty = true});
  write_cutout_picture(to.folder.file("rest.png"), to.drawer(), camera, rest);
  write_labels(to.folder.file("labels.u8"), to.scene, owner);
  return saved.gaussians;
}

}  // namespace splatcut
