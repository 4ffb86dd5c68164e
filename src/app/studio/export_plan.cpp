#include "app/studio/export_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/output_folder.h"
#include "scene/error.h"

namespace splatcut {

namespace {

constexpr std::array<const char*, 4> kSceneExtensions = {".compressed.ply", ".ply", ".splat", ".spz"};

std::uint64_t ply_row_bytes(const Scene& scene) {
  if (scene.format == SceneFormat::kPly && scene.file_rows > 0) return scene.file_bytes / scene.file_rows;
  const auto floats = 3 + 3 + 3 + scene.cloud.sh_stride() + 1 + 3 +
                      4;  // position, normal, f_dc, rest, opacity, scale, rotation
  return floats * sizeof(float);
}

void save(const std::filesystem::path& path, const Scene& scene, const std::vector<std::uint8_t>& keep,
          const ExportRequest& request, ExportReport* report) {
  if (count_flags(keep) == 0)
    throw Error(path.filename().string(), "would hold no Gaussians", "Select something first");
  check_output_file(path, request.overwrite);
  const SaveReport saved = save_scene(path, scene, keep, request.format);
  report->gaussians += saved.gaussians;
  report->bytes += saved.bytes;
  report->loss = saved.loss;
  ++report->files;
}

}  // namespace

std::string file_name_of(const std::string& object_name) {
  std::string name;
  for (const char c : object_name) name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
  return name.empty() ? "object" : name;
}

const char* extension_of(SceneFormat format) {
  switch (format) {
    case SceneFormat::kPly:
      return ".ply";
    case SceneFormat::kCompressedPly:
      return ".compressed.ply";
    case SceneFormat::kSplat:
      return ".splat";
    case SceneFormat::kSpz:
      return ".spz";
  }
  return ".ply";
}

std::filesystem::path with_extension(const std::filesystem::path& path, SceneFormat format) {
  std::string name = path.filename().string();
  for (const std::string_view extension : kSceneExtensions)
    if (name.size() > extension.size() && name.ends_with(extension)) {
      name.resize(name.size() - extension.size());
      break;
    }
  return path.parent_path() / (name + extension_of(format));
}

ExportPlan plan_export(const Scene& scene, std::size_t gaussians, SceneFormat format) {
  ExportPlan plan;
  plan.gaussians = gaussians;
  const int degree = scene.cloud.sh_degree;
  const std::uint64_t rest = scene.cloud.sh_stride();
  switch (format) {
    case SceneFormat::kPly:
      plan.bytes = gaussians * ply_row_bytes(scene) + 1500;
      plan.kept = scene.format == SceneFormat::kPly
                      ? "Every property of every row, byte for byte as in the source file."
                      : "Everything the source file holds, as ordinary 32-bit 3DGS properties.";
      break;
    case SceneFormat::kCompressedPly:
      plan.bytes = gaussians * (16 + rest) + (gaussians / 256 + 1) * 72 + 900;
      plan.kept = "Position, rotation, scale, colour and opacity in 16 bytes a Gaussian.";
      plan.lost = degree > 0 ? fmt::format(
                                   "Precision: 11 bits for positions within chunks of 256, 8 bits for colour "
                                   "and for SH of degree {}.",
                                   degree)
                             : "Precision: 11 bits for positions within chunks of 256, 8 bits for colour.";
      break;
    case SceneFormat::kSplat:
      plan.bytes = gaussians * 32;
      plan.kept = "Position and scale in full; colour, opacity and rotation in 8 bits.";
      plan.lost =
          degree > 0
              ? fmt::format("View-dependent colour: spherical harmonics of degree {} are dropped.", degree)
              : "Precision: colour, opacity and rotation have 8 bits.";
      break;
    case SceneFormat::kSpz:
      plan.bytes = gaussians * (20 + rest) * 3 / 4 + 64;
      plan.about = true;
      plan.kept = "Everything, quantised and packed.";
      plan.lost =
          "Precision: 24-bit fixed point positions, 8 bits for scale, colour and rotation, fewer for SH.";
      break;
  }
  return plan;
}

ExportReport run_export(const Scene& scene, const Document& document, ObjectId object,
                        const ExportRequest& request) {
  const std::size_t n = scene.cloud.size();
  ExportReport report;
  if (request.what == ExportWhat::kAllObjects) {
    std::filesystem::create_directories(request.path);
    for (const ObjectItem& item : document.objects) {
      const std::vector<std::uint8_t> labels = labels_of(document, item, n);
      if (count_flags(labels) == 0) continue;
      save(request.path / (file_name_of(item.name) + extension_of(request.format)), scene, labels, request,
           &report);
    }
    if (report.files == 0) throw Error("export", "no object holds any Gaussians", "Select something first");
    return report;
  }
  const ObjectItem* item = document.find(object);
  if (!item) throw Error("export", "no object is chosen", "Click an object first");
  std::vector<std::uint8_t> keep = labels_of(document, *item, n);
  if (request.what == ExportWhat::kRest)
    for (std::size_t g = 0; g < n; ++g) keep[g] = !keep[g] && !(document.deleted && (*document.deleted)[g]);
  save(request.path, scene, keep, request, &report);
  return report;
}

std::string human_bytes(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value < 1e3) return fmt::format("{} bytes", bytes);
  if (value < 1e6) return fmt::format("{:.0f} kB", value / 1e3);
  if (value < 1e9) return fmt::format("{:.1f} MB", value / 1e6);
  return fmt::format("{:.2f} GB", value / 1e9);
}

}  // namespace splatcut
