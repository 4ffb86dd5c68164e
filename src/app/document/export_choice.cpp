#include "app/document/export_choice.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "app/document/words.h"

namespace splatcut {

namespace {

bool can_be_written(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::is_directory(folder, ignored) &&
         ::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0;
}

bool changes_edges(const EdgesKnown& edges) {
  return edges.clean && edges.unknown + edges.cleaned > 0;
}

bool has_numbers(const ExportChoice& choice) {
  return choice.what == ExportWhat::kOneFile && choice.format.name == SceneFormat::kPly.name;
}

std::string edges_change_text(const ExportChoice& choice, const EdgesKnown& edges) {
  if (!changes_edges(edges)) return {};
  if (choice.what == ExportWhat::kRest)
    return "Clean edges leave out faint remains of the object, too; what they trim off the object stays "
           "here.";
  const std::string gone =
      edges.unknown > 0    ? "leave out what only shows, as ragged bits, once the object stands alone"
      : edges.left_out > 0 ? fmt::format(
                                 "leave out {} that only show, as ragged bits, once the object "
                                 "stands alone",
                                 gaussians_text(edges.left_out))
                           : "leave out nothing";
  return fmt::format("Clean edges {}, and trim or recolour others. Untick them to write all as it is.", gone);
}

}  // namespace

std::filesystem::path folder_to_write(const std::filesystem::path& wanted) {
  const char* home = std::getenv("HOME");
  if (can_be_written(wanted) || !home || !*home) return wanted;
  for (const std::filesystem::path& folder :
       {std::filesystem::path(home) / "Documents", std::filesystem::path(home)})
    if (can_be_written(folder)) return folder;
  return wanted;
}

std::filesystem::path folder_of_next(const std::filesystem::path& scene, const std::filesystem::path& last) {
  return can_be_written(last) ? last : folder_to_write(std::filesystem::absolute(scene).parent_path());
}

std::string proposed_path(const ExportChoice& choice, const std::filesystem::path& scene,
                          const ObjectItem* object, const std::filesystem::path& last) {
  const std::filesystem::path folder =
      choice.path.empty() ? folder_of_next(scene, last) : std::filesystem::path(choice.path).parent_path();
  std::string stem = scene_name(scene);
  stem = stem.substr(0, stem.find('.'));
  std::string name = choice.what == ExportWhat::kRest    ? "rest"
                     : choice.what == ExportWhat::kScene ? "scene"
                     : choice.what == ExportWhat::kAllObjects || choice.what == ExportWhat::kOneFile
                         ? "objects"
                     : object ? object->name
                              : "object";
  for (char& c : name)
    if (c == ' ' || c == '/') c = '_';
  const std::string extension = choice.what == ExportWhat::kAllObjects ? "" : choice.format.extension;
  return free_path(folder / (stem + "_" + name + extension), extension).string();
}

std::filesystem::path typed_in(const std::filesystem::path& folder, const std::filesystem::path& typed) {
  return typed.empty() || typed.is_absolute() || folder.empty() ? typed : folder / typed;
}

std::filesystem::path target_of(const ExportChoice& choice) {
  const bool folder = choice.what == ExportWhat::kAllObjects;
  const bool complete = folder || choice.path.empty() || choice.path.ends_with(choice.format.extension);
  return typed_in(choice.folder, complete ? choice.path : choice.path + choice.format.extension);
}

std::string whose_text(const Document& document, ExportWhat what) {
  const ObjectItem* object = document.active_object();
  if (!object || (what != ExportWhat::kObject && what != ExportWhat::kRest)) return {};
  constexpr std::size_t kMostNamed = 3;
  std::string others;
  std::size_t count = 0;
  for (const ObjectItem& other : document.objects) {
    if (other.id == object->id || (!other.cut && !other.hand) || is_part_of(document, other, object->id))
      continue;
    if (++count <= kMostNamed) others += (others.empty() ? "" : ", ") + other.name;
  }
  if (count == 0) return {};
  if (what == ExportWhat::kObject) return "Of " + object->name + " alone.";
  if (count > kMostNamed) others += fmt::format(" and {} more", count - kMostNamed);
  return fmt::format("All but {}: {} {} in it.", object->name, others, count == 1 ? "stays" : "stay");
}

void EdgesKnown::count(const std::optional<CleanReport>& report, const std::string& name) {
  if (!report) {
    ++unknown;
  } else if (report->cleaned) {
    ++cleaned;
    left_out += report->left;
  } else if (kept++ == 0) {
    kept_of = name;
    why_kept = report->why_not;
  }
}

std::size_t left_to_write(const ExportChoice& choice, std::size_t gaussians, const EdgesKnown& edges,
                          const HoleKnown& hole) {
  if (choice.what != ExportWhat::kRest) return gaussians - std::min(edges.left_out, gaussians);
  if (!hole.without) return gaussians;
  const RestChanges &edge = hole.without->changes, &fill = hole.without->patch.changes;  // no ghost in both
  return gaussians + edge.given_back.size() + fill.given_back.size() -
         std::min(edge.ghosts.size() + fill.ghosts.size(), gaussians);
}

std::string amount_text(const ExportChoice& choice, std::size_t gaussians, const EdgesKnown& edges,
                        const HoleKnown& hole, const FormatPlan& plan) {
  const bool rest = choice.what == ExportWhat::kRest;
  const bool fills = hole.fill && hole.why_not().empty();
  const bool about = rest && (fills || changes_edges(edges)),
             at_most = !rest && edges.clean && edges.unknown > 0;
  return fmt::format("{}{} Gaussians, {}{}",
                     about     ? "About "
                     : at_most ? "At most "
                               : "",
                     grouped(left_to_write(choice, gaussians, edges, hole)),
                     about || plan.about ? "about " : "", human_bytes(plan.bytes));
}

std::string kept_text(const ExportChoice& choice, const FormatPlan& plan, const std::string& changes) {
  std::string what = plan.kept;  // a sentence
  if (!what.empty()) what[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(what[0])));
  return (choice.placement != ExportPlacement{} ? "Written: "
          : changes.empty()                     ? "Kept: "
                                                : "Written, with the changes named below: ") +
         what;
}

std::uint64_t bytes_of_numbers(const ExportChoice& choice, std::size_t gaussians) {
  return has_numbers(choice) ? gaussians * sizeof(std::uint8_t) : 0;
}

std::string numbers_text(const ExportChoice& choice) {
  if (choice.what != ExportWhat::kOneFile) return {};
  return has_numbers(choice)
             ? "object_id says the object's place in the list; names go to a .json beside the file."
             : "Which object a Gaussian belongs to is kept in a .ply alone.";
}

std::string moved_text(const ExportPlacement& placement) {
  return placement == ExportPlacement{} ? "" : "It stands as chosen above, not as in the scene.";
}

std::string edges_stay_text(const EdgesKnown& edges) {
  if (!edges.clean || edges.kept == 0) return {};
  if (edges.kept == 1)
    return fmt::format("Clean edges leave {} as it is: {}.", edges.kept_of, edges.why_kept);
  return fmt::format("Clean edges leave {} objects as they are ({} the first): {}.", edges.kept,
                     edges.kept_of, edges.why_kept);
}

std::string changes_text(const ExportChoice& choice, const EdgesKnown& edges, const HoleKnown& hole) {
  const std::string of_edges = edges_change_text(choice, edges);
  if (choice.what != ExportWhat::kRest || !hole.fill || !hole.why_not().empty()) return of_edges;
  const std::string of_hole =
      hole.without
          ? fmt::format("The hole is filled by {}, all invented; what lies there and at the rim is replaced.",
                        gaussians_text(hole.without->patch.changes.given_back.size()))
          : "If the object touches a flat surface, that is continued into the hole: what lies there and "
            "at the rim is replaced, and what fills it is invented.";
  return of_edges + (of_edges.empty() ? "" : " ") + of_hole;
}

std::string loss_text(const ExportChoice& choice, const EdgesKnown& edges, const HoleKnown& hole,
                      const FormatPlan& plan) {
  if (!plan.lost.empty()) return "Lost: " + plan.lost;
  const bool loses_objects =
      choice.what == ExportWhat::kOneFile && choice.format.name != SceneFormat::kPly.name;
  return changes_text(choice, edges, hole).empty() && !loses_objects ? "Nothing is lost." : "";
}

bool names_written_format(std::string_view path) {
  const SceneFormat* named = find_format(std::filesystem::path(path));
  return named && named->write && path.ends_with(named->extension);
}

void follow_typed_name(ExportChoice& choice) {
  const SceneFormat* named = choice.what == ExportWhat::kAllObjects ? nullptr : find_format(choice.path);
  if (named && named->write && choice.path.ends_with(named->extension)) choice.format = *named;
}

}  // namespace splatcut
