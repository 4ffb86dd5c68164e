#include "app/console/kept_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/lower_case.h"
#include "scene/formats/scene_formats.h"

namespace splatcut {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  return fs::equivalent(a, b, missing) && !missing;
}

namespace {

// By its place behind all links, or by another name of it in the folder.
bool holds(const fs::path& folder, const fs::path& input) {
  std::error_code failure;
  const fs::path place = fs::canonical(input, failure);
  for (fs::path above = place.parent_path(); !failure; above = above.parent_path()) {
    if (same_file(above, folder)) return true;
    if (above == above.parent_path()) break;
  }
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure))
    if (same_file(at->path(), input)) return true;
  return false;
}

}  // namespace

void refuse_written_inputs(const fs::path& output, const std::vector<fs::path>& inputs) {
  const fs::path part = fs::path(output) += ".splatcut.part";  // what AtomicFile writes first
  for (const fs::path& input : inputs)
    if (!input.empty() && same_file(part, input))
      throw Error(input.string(), fmt::format("is read here, and {} is written through it", output.string()),
                  "It would be lost: give it another name first");
  std::error_code failure;
  const fs::file_type there = fs::status(output, failure).type();
  if (there != fs::file_type::regular && there != fs::file_type::directory) return;
  for (const fs::path& input : inputs) {
    if (input.empty() || !fs::exists(input, failure)) continue;
    if (same_file(output, input))
      throw Error(output.string(), fmt::format("is what is read here ({})", input.string()),
                  "It would be lost: choose another place to write to");
    if (there == fs::file_type::regular && fs::is_directory(input, failure) && holds(input, output))
      throw Error(output.string(), fmt::format("lies in {}, which is read here", input.string()),
                  "It could be lost: choose another place to write to");
    if (there == fs::file_type::directory && holds(output, input))
      throw Error(output.string(), fmt::format("holds {}, which is read here", input.string()),
                  "It could be lost: choose another folder to write to");
  }
}

void refuse_scene_name(const fs::path& picture) {
  if (const SceneFormat* format = find_format(picture))
    throw Error(picture.string(),
                fmt::format("is the name of a scene ({}), and a picture is to be written", format->extension),
                "Choose a name that ends with .png");
}

void refuse_name_of_png(const fs::path& picture) {
  refuse_scene_name(picture);
  constexpr std::array kOthers = {".jpg", ".jpeg", ".webp", ".bmp",  ".gif", ".tif", ".tiff",
                                  ".exr", ".tga",  ".heic", ".avif", ".pdf", ".svg"};
  const std::string ending = lower_case(picture.extension().string());
  if (std::ranges::find(kOthers, ending) != kOthers.end())
    throw Error(picture.string(),
                fmt::format("is the name of another kind of picture ({}), and a PNG is written", ending),
                "Choose a name that ends with .png, and convert it");
}

}  // namespace splatcut
