#include "app/studio/export_plan.h"

#include <fmt/format.h>

#include "app/console/output_folder.h"
#include "core/error.h"

namespace splatcut {

namespace {

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

std::string free_file_name(const std::string& object_name, std::set<std::string>* taken) {
  const std::string name = file_name_of(object_name);
  std::string free = name;
  for (int number = 2; !taken->insert(free).second; ++number) free = fmt::format("{}_{}", name, number);
  return free;
}

ExportReport run_export(const Scene& scene, const Document& document, ObjectId object,
                        const ExportRequest& request) {
  const std::size_t n = scene.cloud.size();
  ExportReport report;
  if (request.what == ExportWhat::kAllObjects) {
    std::filesystem::create_directories(request.path);
    std::set<std::string> taken;
    for (const ObjectItem& item : document.objects) {
      const std::vector<std::uint8_t> labels = labels_of(document, item, n);
      if (count_flags(labels) == 0) continue;
      const std::string name = free_file_name(item.name, &taken);
      save(request.path / (name + request.format.extension), scene, labels, request, &report);
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
