#include "app/document/export_plan.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/console/kept_inputs.h"
#include "app/console/labels_file.h"
#include "app/console/output_folder.h"
#include "app/document/label_cache.h"
#include "app/document/words.h"
#include "core/error.h"

namespace splatcut {

namespace {

// What all files of an export share.
struct Exporting {
  const Scene& scene;
  const ExportRequest& request;
  const Document& document;
  CleanObjects* clean;  // null: rows stay as they are
  const Job& job;
  std::span<const std::uint8_t> object_ids = {};  // see SaveOptions
};

// Null where the object's rows are written as they are, or where it was cancelled.
std::shared_ptr<const CleanObject> clean_edges_of(const Flags& labels, const std::string& name,
                                                  const Exporting& what, ExportReport* report) {
  if (!what.request.clean_edges) return nullptr;
  auto object = what.clean->made(labels, what.document.up_world, what.job);
  if (!object) return nullptr;
  count_edges(object->report, report, name);
  return object->report.cleaned ? object : nullptr;
}

// object: the labels of the one that `keep` holds, or that it is the rest of; null: of none. name: where
// there are several.
void save(const std::filesystem::path& path, const std::vector<std::uint8_t>& keep, const Flags& object,
          const std::string& name, const std::optional<Similarity>& to, const Exporting& what,
          ExportReport* report) {
  const ExportRequest& request = what.request;
  if (count_flags(keep) == 0)
    throw Error(path.filename().string(), "would hold no Gaussians", "Select something first");
  refuse_written_inputs(path, what.scene.files);
  check_output_file(path, request.overwrite, "Choose another name, or to write over it");
  const bool is_rest = request.what == ExportWhat::kRest;
  const std::shared_ptr<const CleanObject> clean =
      object && !is_rest ? clean_edges_of(object, name, what, report) : nullptr;
  RestChanges changes, filled;
  if (object && is_rest && (request.clean_edges || request.fill_hole)) {
    const auto without = what.clean->made_without(
        {object, what.document.deleted, what.document.up_world, request.clean_edges, request.fill_hole},
        what.job);
    if (!without) return;
    if (request.clean_edges) count_edges(without->edges, report);
    report->hole_kept = without->patch.why_not;
    report->invented += without->patch.changes.given_back.size();
    changes = without->changes;
    filled = without->patch.changes;
  }
  report->not_given_back += spare_copy(what.scene, request.format, to.has_value(), filled, &changes);
  add(filled, &changes);
  if (what.job.cancelled()) return;
  std::optional<MovedTo> moved;
  if (to) moved = {*to, request.placement.origin == ExportOrigin::kScene};
  const SaveOptions options{.up = what.document.up_world, .object_ids = what.object_ids};
  const SaveReport saved =
      clean ? save_gaussians(path, what.scene, keep, &clean->cloud, request.format, moved, options)
            : save_rest(path, what.scene, keep, changes, request.format, moved, options);
  report->gaussians += saved.gaussians;
  report->bytes += saved.bytes;
  report->loss = saved.loss;
  ++report->files;
}

// The place in the list of the last object that has the Gaussian, from 1; 0: none has it.
std::vector<std::uint8_t> owners(const Document& document, std::size_t gaussians, LabelCache* known) {
  std::vector<std::uint8_t> owner(gaussians, 0);
  for (std::size_t o = 0; o < document.objects.size(); ++o) {
    const Flags labels = known_labels(document, document.objects[o], gaussians, known);
    const auto number = static_cast<std::uint8_t>(o + 1);
    const std::uint8_t* is_own = labels->data();
    std::uint8_t* to = owner.data();
    for (std::size_t g = 0; g < gaussians; ++g) to[g] = is_own[g] ? number : to[g];  // it is no branch
  }
  return owner;
}

// Where the file can say the numbers, what they stand for.
void save_in_one(const std::vector<std::uint8_t>& owner, const std::optional<Similarity>& to, Exporting what,
                 ExportReport* report) {
  const ExportRequest& request = what.request;
  if (request.format.name != SceneFormat::kPly.name) {
    save(request.path, owner, nullptr, {}, to, what, report);
    report->loss += (report->loss.empty() ? "" : "; ") + std::string("which object a Gaussian belongs to");
    return;
  }
  const std::filesystem::path names = std::filesystem::path(request.path).replace_extension(".json");
  refuse_written_inputs(names, what.scene.files);
  refuse_other_than_names(names);
  check_output_file(names, request.overwrite, "Choose another name, or to write over it");
  what.object_ids = owner;
  save(request.path, owner, nullptr, {}, to, what, report);
  if (what.job.cancelled()) return;
  std::vector<std::string> objects;
  for (const ObjectItem& item : what.document.objects) objects.push_back(item.name);
  write_object_names(names, objects);
}

// Bytes of the character of UTF-8 that the text begins with: 1 for one of ASCII, 0 for what is none or
// controls (U+0080 to U+009F).
std::size_t bytes_of_letter(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t bytes = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
  if (byte(0) < 0xc2 || byte(0) > 0xf4 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i)
    if (byte(i) < 0x80 || byte(i) > 0xbf) return 0;
  const bool overlong = (byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xf0 && byte(1) < 0x90);
  const bool no_letter = (byte(0) == 0xed && byte(1) > 0x9f) || (byte(0) == 0xf4 && byte(1) > 0x8f) ||
                         (byte(0) == 0xc2 && byte(1) < 0xa0);
  return overlong || no_letter ? 0 : bytes;
}

}  // namespace

std::vector<std::uint8_t> exported(const Document& document, ObjectId object, ExportWhat what,
                                   std::size_t gaussians, LabelCache* known) {
  if (what == ExportWhat::kAllObjects || what == ExportWhat::kOneFile)
    return owners(document, gaussians, known);
  const ObjectItem* item = document.find(object);
  if (what == ExportWhat::kObject)
    return item ? *known_labels(document, *item, gaussians, known) : std::vector<std::uint8_t>(gaussians, 0);
  std::vector<std::uint8_t> keep(gaussians, 1);
  if (what == ExportWhat::kRest && item) keep = *known_labels(document, *item, gaussians, known);
  for (std::size_t g = 0; g < gaussians; ++g) {
    if (what == ExportWhat::kRest && item) keep[g] = !keep[g];
    if (document.deleted && (*document.deleted)[g]) keep[g] = 0;
  }
  return keep;
}

std::string file_name_of(const std::string& object_name) {
  std::string name;
  for (std::size_t i = 0; i < object_name.size();) {
    const char c = object_name[i];
    const bool stays = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-';
    const std::size_t bytes = bytes_of_letter(std::string_view(object_name).substr(i));
    name += bytes > 1 ? object_name.substr(i, bytes) : std::string(1, stays ? c : '_');
    i += std::max<std::size_t>(bytes, 1);
  }
  return name.empty() ? "object" : name;
}

std::string free_file_name(const std::string& object_name, std::set<std::string>* taken) {
  const std::string name = file_name_of(object_name);
  std::string free = name;
  for (int number = 2; !taken->insert(free).second; ++number) free = fmt::format("{}_{}", name, number);
  return free;
}

void visit_objects(const Document& document, std::size_t gaussians,
                   const std::function<void(const ObjectToSave&)>& visit, LabelCache* known) {
  std::set<std::string> taken;
  for (const ObjectItem& item : document.objects) {
    const Flags labels = known_labels(document, item, gaussians, known);
    if (count_flags(*labels) > 0) visit({item.name, free_file_name(item.name, &taken), *labels});
  }
}

SaveReport save_gaussians(const std::filesystem::path& path, const Scene& scene,
                          const std::vector<std::uint8_t>& keep, const GaussianCloud* instead,
                          const SceneFormat& format, const std::optional<MovedTo>& to,
                          const SaveOptions& options) {
  if (!instead && !to) return save_scene(path, scene, keep, format, options);
  Scene other = with_cloud(scene, !to       ? *instead
                                  : instead ? placed(*instead, {}, to->by)
                                            : placed(scene.cloud, keep, to->by));
  if (to && !to->adds_origin) other.origin = glm::dvec3(0);
  const auto turn = [&](std::optional<glm::vec3>* up) {
    if (to && *up) *up = to->by.rotation * **up;
  };
  turn(&other.up);
  std::vector<std::uint8_t> ids;  // of the Gaussians that are kept
  for (std::size_t g = 0; g < options.object_ids.size(); ++g)
    if (keep.empty() || keep[g]) ids.push_back(options.object_ids[g]);
  SaveOptions of_other = options;
  of_other.object_ids = ids;
  turn(&of_other.up);
  return save_scene(path, other, {}, format, of_other);
}

bool rest_is_copy(const Scene& scene, const SceneFormat& format, bool moved, const RestChanges& changes) {
  const bool beside = format.name == SceneFormat::kPly.name && scene.rows_can_be_changed;
  return moved || (!changes.given_back.empty() && !beside);
}

std::size_t spare_copy(const Scene& scene, const SceneFormat& format, bool moved, const RestChanges& filled,
                       RestChanges* changes) {
  const bool copied_for_them =
      rest_is_copy(scene, format, moved, *changes) && !rest_is_copy(scene, format, moved, filled);
  if (!copied_for_them || scene.cloud.size() <= kMostToCopy) return 0;
  return std::exchange(changes->given_back, {}).size();
}

SaveReport save_rest(const std::filesystem::path& path, const Scene& scene, std::vector<std::uint8_t> keep,
                     const RestChanges& changes, const SceneFormat& format, const std::optional<MovedTo>& to,
                     SaveOptions options) {
  if (!changes.given_back.empty() && rest_is_copy(scene, format, to.has_value(), changes)) {
    const GaussianCloud rest = rest_of(scene.cloud, keep, changes);
    return save_gaussians(path, scene, {}, &rest, format, to, options);
  }
  for (const std::uint32_t g : changes.ghosts) keep[g] = 0;
  if (!changes.given_back.empty()) options.changed_rows = &changes.given_back;
  return save_gaussians(path, scene, keep, nullptr, format, to, options);
}

void count_edges(const CleanReport& clean, ExportReport* report, const std::string& name) {
  if (!clean.cleaned && report->kept++ == 0) {
    report->edges_kept = clean.why_not;
    report->edges_kept_of = name;
  }
  report->clean += clean.cleaned;
}

std::string edges_text(const ExportReport& report) {
  std::string text;
  if (report.clean > 0) text += report.edges_kept.empty() ? ", edges cleaned" : ", edges of some cleaned";
  if (report.edges_kept.empty()) return text;
  const std::string& name = report.edges_kept_of;
  const std::string whose = report.kept > 1 ? fmt::format(" of {} objects", report.kept)
                            : !name.empty() ? " of " + name
                                            : "";
  return text + fmt::format(". Edges{} stay as they are{}: {}", whose,
                            report.kept > 1 ? ", " + name + " the first" : "", report.edges_kept);
}

std::string text_of(const ExportReport& report, const std::filesystem::path& path) {
  const std::string invented =
      report.invented == 0 ? ""
                           : fmt::format(", {} of them invented to fill the hole", grouped(report.invented));
  std::string text = fmt::format("{} Gaussians{}, {} saved to {}{}", grouped(report.gaussians), invented,
                                 human_bytes(report.bytes), path.string(), edges_text(report));
  if (report.not_given_back > 0)
    text += fmt::format(". {} pieces cut off the object are not in the rest, which is too large to copy",
                        report.not_given_back);
  if (!report.hole_kept.empty()) text += ". No hole is filled: " + report.hole_kept;
  if (!report.loss.empty()) text += ". Lost: " + report.loss;
  return text;
}

ExportReport run_export(const Scene& scene, const Document& document, ObjectId object,
                        const ExportRequest& request, CleanObjects* clean, const Job& job) {
  const std::size_t n = scene.cloud.size();
  if (!(request.placement.scale > 0) || !std::isfinite(request.placement.scale))
    throw Error("", "The scale must be larger than 0");
  const glm::vec3& move = request.placement.move;
  if (!std::isfinite(request.placement.turn_deg) || !std::isfinite(move.x) || !std::isfinite(move.y) ||
      !std::isfinite(move.z))
    throw Error("", "The turn and the move must be ordinary numbers");
  const auto place = [&](const std::vector<std::uint8_t>& kept) -> std::optional<Similarity> {
    if (request.placement == ExportPlacement{}) return {};
    return similarity_of(request.placement, scene.cloud, kept, document.up_world, request.format.axes);
  };
  const Exporting what{scene, request, document, clean, job};
  ExportReport report;
  if (request.what == ExportWhat::kAllObjects) {
    std::filesystem::create_directories(request.path);
    const auto to = place(exported(document, object, request.what, n));  // objects stay beside each other
    visit_objects(document, n, [&](const ObjectToSave& o) {
      if (!job.cancelled())
        save(request.path / (o.file + request.format.extension), o.labels, make_flags(o.labels), o.name, to,
             what, &report);
    });
    if (report.files == 0 && !job.cancelled())
      throw Error("", "No object holds any Gaussians", "Select something first");
    return report;
  }
  if (!request.path.string().ends_with(request.format.extension))
    throw Error(request.path.string(), fmt::format("does not end with {}", request.format.extension),
                "It could not be opened again");
  if (request.what == ExportWhat::kOneFile) {
    const std::vector<std::uint8_t> owner = exported(document, object, request.what, n);
    save_in_one(owner, place(owner), what, &report);
    return report;
  }
  if (request.what != ExportWhat::kScene && !document.find(object))
    throw Error("", "No object is chosen", "Click an object first");
  const std::vector<std::uint8_t> keep = exported(document, object, request.what, n);
  const ObjectItem* item = request.what == ExportWhat::kScene ? nullptr : document.find(object);
  save(request.path, keep, item ? make_flags(labels_of(document, *item, n)) : nullptr, {}, place(keep), what,
       &report);
  return report;
}

std::filesystem::path free_path(const std::filesystem::path& path, const std::string& extension) {
  std::error_code ignored;
  const std::string name = path.filename().string();
  const bool ends = !extension.empty() && name.ends_with(extension);
  const std::string stem = ends ? name.substr(0, name.size() - extension.size()) : name;
  std::filesystem::path free = path;
  for (int number = 2; std::filesystem::exists(free, ignored); ++number)
    free = path.parent_path() / fmt::format("{}_{}{}", stem, number, ends ? extension : "");
  return free;
}

std::string human_bytes(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value < 1e3) return fmt::format("{} bytes", bytes);
  if (value < 1e6) return fmt::format("{:.0f} kB", value / 1e3);
  if (value < 1e9) return fmt::format("{:.1f} MB", value / 1e6);
  return fmt::format("{:.2f} GB", value / 1e9);
}

}  // namespace splatcut
