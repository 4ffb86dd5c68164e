#include "app/work/work_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/work/work_document.h"
#include "app/work/work_history.h"
#include "app/work/work_values.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

using nlohmann::json;

// Version 7: the scene's hash is XXH3. Version 8: what an object leaves to others; a program that knew
// nothing of it would give objects Gaussians that they do not have. Version 9: every stroke has its size;
// until then objects had a "part_step", that of their first stroke. Else all of version 7 means the same in
// version 9.
constexpr int kOldest = 7, kVersion = 9;

constexpr const char* kDisplayNames[] = {"scene", "object", "rest", "side by side", "before and after"};

// The scene where it is no such name: older work holds none.
DisplayMode display_of_name(const std::string& name) {
  const auto found = std::ranges::find(kDisplayNames, name);
  return found == std::end(kDisplayNames) ? DisplayMode::kWhole
                                          : static_cast<DisplayMode>(found - std::begin(kDisplayNames));
}

constexpr std::size_t kMostRows = std::size_t{1} << 28;  // of a file that is missing

json parse(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw Error(path.string(), "is no file, or is not there");
  json work = json_of_file(path);
  if (!work.is_object() || !work.contains("splatcut_work"))
    throw Error(path.string(), "is no work file of splatcut");
  const json& version = work["splatcut_work"];
  if (!version.is_number_integer() || version < kOldest || version > kVersion)
    throw Error(path.string(),
                fmt::format("is of version {}, this splatcut reads versions {} to {}", json_text(version),
                            kOldest, kVersion),
                "Open the scene itself to start anew");
  return work;
}

// A file beside or below the work file moves with it.
void put_path(const std::filesystem::path& file, const std::filesystem::path& work, const std::string& key,
              json* source) {
  const std::filesystem::path absolute = std::filesystem::absolute(file).lexically_normal();
  const std::filesystem::path relative =
      absolute.lexically_relative(std::filesystem::absolute(work).parent_path().lexically_normal());
  const bool beside = !relative.empty() && !relative.string().starts_with("..");
  const std::string place = (beside ? relative : absolute).string();
  (*source)[key] = place;
  if (!is_utf8(place)) (*source)[key + "_bytes"] = std::vector<std::uint8_t>(place.begin(), place.end());
}

std::filesystem::path path_from(const json& said, const std::string& key, const std::filesystem::path& work) {
  std::filesystem::path path = said.at(key).get<std::string>();
  if (said.contains(key + "_bytes")) {
    const auto bytes = said.at(key + "_bytes").get<std::vector<std::uint8_t>>();
    path = std::string(bytes.begin(), bytes.end());
  }
  return path.is_absolute() ? path : std::filesystem::absolute(work).parent_path() / path;
}

json source_json(const SceneSource& file, const std::filesystem::path& work) {
  json source = {{"hash", fmt::format("{:016x}", file.hash)}, {"gaussians", file.gaussians}};
  if (file.file_rows != file.gaussians) source["rows"] = file.file_rows;
  put_path(file.path, work, "path", &source);
  if (!file.cameras.empty()) put_path(file.cameras, work, "cameras", &source);
  if (file.spz_axes) source["spz_axes"] = name_of(*file.spz_axes);
  if (file.lod.value_or(0) > 0) source["lod"] = *file.lod;
  if (file.fills != 0) source["fills"] = file.fills;
  if (file.origin && *file.origin != glm::dvec3(0))
    source["origin"] = {file.origin->x, file.origin->y, file.origin->z};
  if (file.place != ScenePlace{})
    source["place"] = {{"move", list(file.place.move)},
                       {"turn_deg", list(file.place.turn_deg)},
                       {"scale", file.place.scale}};
  return source;
}

SceneSource source_from(const json& said, const std::filesystem::path& work) {
  SceneSource file;
  file.path = path_from(said, "path", work);
  if (said.contains("cameras")) file.cameras = path_from(said, "cameras", work);
  const std::string hash = said.at("hash");
  if (std::from_chars(hash.data(), hash.data() + hash.size(), file.hash, 16).ec != std::errc())
    throw Error(work.string(), "does not say which scene it belongs to: its \"hash\" is no number");
  file.gaussians = said.value("gaussians", std::size_t{0});
  file.file_rows = said.value("rows", file.gaussians);
  file.spz_axes = spz_axes_from_name(said.value("spz_axes", ""));
  file.lod = said.value("lod", 0u);                         // older work holds none
  file.fills = said.value("fills", 0u);                     // older work holds none
  const json origin = said.value("origin", json{0, 0, 0});  // older work holds none
  file.origin = {origin.at(0).get<double>(), origin.at(1).get<double>(), origin.at(2).get<double>()};
  if (!said.contains("place")) return file;
  const json& place = said["place"];
  file.place = {vec3_from(place.at("move")), vec3_from(place.at("turn_deg")), place.at("scale").get<float>()};
  check(file.place, file.path);
  return file;
}

void add_warning(const std::string& warning, RestoredWork* work) {
  work->warning += (work->warning.empty() ? "" : "; ") + warning;
}

// The work is what counts: steps that cannot be read are left out, and that is said.
void read_history(const json& said, const Scene& scene, RestoredWork* work) {
  if (said.is_null()) return;
  std::string fault;
  try {
    work->history = history_from(said, scene, work->document);
    return;
  } catch (const Error& error) {
    fault = error.unstopped();
  } catch (const json::exception& error) {
    fault = fault_of(error);
  }
  add_warning("the steps before it cannot be undone (" + fault + ")", work);
}

}  // namespace

bool is_work_file(const std::filesystem::path& path) {
  return path.string().ends_with(".splatcut.json");
}

WorkFile read_work_file(const std::filesystem::path& path) {
  try {
    json work = parse(path);
    WorkFile out;
    out.path = path;
    out.files.push_back(source_from(work.at("scene"), path));
    for (const json& added : work.value("added", json::array()))
      out.files.push_back(source_from(added, path));
    out.content = std::make_shared<const json>(std::move(work));
    return out;
  } catch (const json::exception& error) {
    throw Error(path.string(), "does not have the expected form (" + fault_of(error) + ")");
  }
}

bool WorkFile::holds_nothing() const {
  const auto has_none = [&](const char* name) {
    const auto found = content->find(name);
    return found == content->end() || found->empty();  // null is empty, too
  };
  return files.size() == 1 && has_none("objects") && has_none("deleted") && !content->contains("history");
}

RestoredWork restored(const WorkFile& file, const OpenedScene& opened) {
  std::vector<GoneRows> gone;
  std::size_t found = 0, row = 0, gone_rows = 0;
  const bool all = opened.files.size() == file.files.size();
  for (std::size_t i = 0; i < file.files.size(); ++i) {
    const SceneSource& said = file.files[i];
    const SceneSource* there = all ? &opened.files[i] : i == 0 ? &opened.files.front() : opened.file(said.id);
    if (there && there->hash != said.hash)
      throw Error(file.path.string(),
                  fmt::format("belongs to another version of {}", said.path.filename().string()),
                  "Its labels would be wrong; open the scene itself to start anew");
    if (!there) {
      gone.push_back({row, said.file_rows});
      gone_rows += said.file_rows;
      if (gone_rows > kMostRows) throw Error(file.path.string(), "names files of more rows than any has");
    }
    found += there != nullptr;
    row += there ? there->file_rows : said.file_rows;
  }
  if (found != opened.files.size()) throw Error(file.path.string(), "belongs to a scene of other files");
  const Scene& scene = *opened.scene;
  try {
    const json& work = *file.content;
    std::vector<const json*> objects;
    for (const json& o : work.at("objects")) objects.push_back(&o);
    std::string unknown_preset;
    Document document = document_from(
        work, objects,
        [&](const json& runs, std::uint8_t most) { return flags_from(runs, scene, most, gone); },
        &unknown_preset);
    for (ObjectItem& object : document.objects) object.cut_kept |= object.cut && !gone.empty();
    RestoredWork out{std::move(document), {}, {}, {}};
    if (!unknown_preset.empty())
      add_warning(
          fmt::format("its method, \"{}\", is not known to this program: what is computed from now on "
                      "is computed by \"{}\"",
                      unknown_preset, out.document.preset),
          &out);
    if (gone.empty()) out.saved_as = work.value("saved_as", "");
    if (work.contains("view"))
      out.view = {pose_from(work.at("view")),
                  display_of_name(work.value("display", "")),
                  work.value("hidden", std::vector<ObjectId>()),
                  {}};
    if (out.view && gone.empty()) out.view->sides = sides_from(work.value("sides", json::array()), scene);
    if (!gone.empty())
      add_warning(
          "the work is shown without what is missing, and no earlier step can be undone. The saved "
          "work stays as it is: save this under another name",
          &out);
    else if (work.contains("history"))
      read_history(work["history"], scene, &out);
    return out;
  } catch (const Error& error) {
    throw Error(file.path.string(), error.unstopped());
  } catch (const json::exception& error) {
    throw Error(file.path.string(), "does not have the expected form (" + fault_of(error) + ")");
  }
}

void write_work_file(const std::filesystem::path& path, const OpenedScene& opened, const Document& document,
                     const std::optional<WorkView>& view, const SavedSteps& history,
                     const std::filesystem::path& saved_as) {
  const Scene& scene = *opened.scene;
  const std::span<const SceneSource> files = opened.files;
  json work = document_json(document, [&scene](const Flags& flags) { return runs_json(flags, scene); });
  work["splatcut_work"] = kVersion;
  work["scene"] = source_json(files.front(), path);
  for (const SceneSource& file : files.subspan(1)) work["added"].push_back(source_json(file, path));
  if (view) {
    work["view"] = pose_json(view->pose);
    work["display"] = kDisplayNames[static_cast<std::size_t>(view->display)];
    if (!view->hidden.empty()) work["hidden"] = view->hidden;
    if (!view->sides.empty()) work["sides"] = sides_json(view->sides, scene);
  }
  if (is_utf8(saved_as.string()) && !saved_as.empty())
    work["saved_as"] = std::filesystem::absolute(saved_as).string();
  if (history.steps.size() > 1) work["history"] = history_json(history, scene);
  write_text_file(path, json_text(work) + "\n");
}

}  // namespace splatcut
