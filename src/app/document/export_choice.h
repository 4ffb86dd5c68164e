// What a user chose of an export so far, and where it goes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "app/document/export_plan.h"
#include "scene/formats/scene_formats.h"

namespace splatcut {

struct ExportChoice {
  ExportWhat what = ExportWhat::kObject;
  bool for_want_of_object = false;  // the whole scene, as there was no object when it was asked for
  SceneFormat format = SceneFormat::kPly;
  std::string path;              // as typed; see target_of()
  std::filesystem::path folder;  // that was proposed: a name alone goes there; empty: none was
  bool overwrite = false;
  bool name_first = false;    // the dialog opens: what is typed first is the name
  std::string marked_folder;  // "…/", before the name that is marked; empty: none is, or it was typed over
  bool path_typed = false;    // or chosen in another dialog
  ExportPlacement placement;  // kept for the next export of the scene
  std::uint32_t placed_file = 0;  // the scene's first, that it is for
  FormatPlan plan;
  std::uint64_t counted_at = 0;  // History::serial() at which all objects together had `in_one` Gaussians
  std::size_t in_one = 0;
  std::string plan_key;                // what it was made for
  std::string trouble;                 // why the last try failed
  std::optional<ExportRequest> tried;  // what that was; none: what the dialog says when it comes back
};

// That folder, or where it cannot be written the user's Documents or home; that folder where neither can.
std::filesystem::path folder_to_write(const std::filesystem::path& wanted);

// Where the next file goes: into `last`, the folder of the last export, or if that is empty, gone or cannot
// be written beside the scene (see folder_to_write()).
std::filesystem::path folder_of_next(const std::filesystem::path& scene, const std::filesystem::path& last);

// A free path for that: in the folder of the present path, else in folder_of_next(). object: null if there is
// none.
std::string proposed_path(const ExportChoice& choice, const std::filesystem::path& scene,
                          const ObjectItem* object, const std::filesystem::path& last = {});

// A typed path: one that does not say from where it begins, as a name alone, begins in the folder; an empty
// one stays so.
std::filesystem::path typed_in(const std::filesystem::path& folder, const std::filesystem::path& typed);

// Where it goes: the path with the format's extension, as under another one the file could not be opened
// again.
std::filesystem::path target_of(const ExportChoice& choice);

// Of whom the file is where there are several objects: what is left of a scene without one of them still
// holds the others, but for its parts. Empty: there is no other, or it is of all.
std::string whose_text(const Document& document, ExportWhat what);

// What is known, before an export, of the edges of the objects that it is about.
struct EdgesKnown {
  bool clean = false;                     // they are to be clean
  std::size_t unknown = 0;                // number of objects that were not cleaned yet
  std::size_t cleaned = 0, left_out = 0;  // number of others; Gaussians that these leave out
  std::size_t kept = 0;                   // number of objects whose edges stay as they are
  std::string kept_of, why_kept;          // the first one's name and reason, without a full stop

  // Of one more object; none: not known yet.
  void count(const std::optional<CleanReport>& report, const std::string& name);
};

// What is known, before an export of the rest, of the hole that the object leaves.
struct HoleKnown {
  bool fill = false;                              // it is to be filled
  std::shared_ptr<const SceneWithout> without{};  // null: not known yet
  // Why it stays; empty: it is filled, or that is not known.
  std::string why_not() const { return fill && without ? without->patch.why_not : ""; }
};

// Number of Gaussians to write where there are so many in the scene: exact where what edges and the hole
// change is known, but for ghosts that were deleted.
std::size_t left_to_write(const ExportChoice& choice, std::size_t gaussians, const EdgesKnown& edges,
                          const HoleKnown& hole = {});

// What the dialog says. How much is written of so many Gaussians: what clean edges change is not known before
// they are made, nor what fills a hole.
std::string amount_text(const ExportChoice& choice, std::size_t gaussians, const EdgesKnown& edges,
                        const HoleKnown& hole, const FormatPlan& plan);
// What a file of that format holds, and that it stands otherwise than in the scene; the second one is empty
// where it does not.
// changes: what changes_text() says.
std::string kept_text(const ExportChoice& choice, const FormatPlan& plan, const std::string& changes = {});
// Whether a file of all objects says which is which; empty: it holds no several. And what that takes.
std::string numbers_text(const ExportChoice& choice);
std::uint64_t bytes_of_numbers(const ExportChoice& choice, std::size_t gaussians);
std::string moved_text(const ExportPlacement& placement);
// Whose edges stay, though clean ones are asked for; empty: nobody's.
std::string edges_stay_text(const EdgesKnown& edges);
// What clean edges and the hole change in what is written; empty: nothing.
std::string changes_text(const ExportChoice& choice, const EdgesKnown& edges, const HoleKnown& hole);
// What is lost by the format, or that nothing is lost at all; empty where only changes_text() has to say.
std::string loss_text(const ExportChoice& choice, const EdgesKnown& edges, const HoleKnown& hole,
                      const FormatPlan& plan);

// Whether the path ends like a format that is written.
bool names_written_format(std::string_view path);

// A typed path that ends like another format means that format.
void follow_typed_name(ExportChoice& choice);

}  // namespace splatcut
