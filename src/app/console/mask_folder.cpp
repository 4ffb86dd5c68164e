#include "app/console/mask_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/error.h"
#include "core/lower_case.h"
#include "core/png_file.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

std::string file_part(const std::string& name) {
  return fs::path(name).filename().string();
}

}  // namespace

std::string without_picture_ending(const std::filesystem::path& name) {
  constexpr std::array kEndings = {".png",  ".jpg", ".jpeg", ".tif", ".tiff",
                                   ".webp", ".bmp", ".exr",  ".heic"};
  if (std::ranges::find(kEndings, lower_case(name.extension().string())) == kEndings.end())
    return name.string();
  return (name.parent_path() / name.stem()).string();
}

std::vector<std::size_t> cameras_named(const std::vector<Camera>& cameras, const std::string& name) {
  std::vector<std::size_t> whole, file_only;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const std::string camera = without_picture_ending(cameras[c].name);
    if (camera.empty()) continue;
    if (camera == name) whole.push_back(c);
    if (file_part(camera) == file_part(name)) file_only.push_back(c);
  }
  return whole.empty() ? file_only : whole;
}

namespace {

std::vector<fs::path> masks_in(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator at(folder, failure), end; !failure && at != end;
       at.increment(failure))
    if (lower_case(at->path().extension().string()) == ".png" && at->is_regular_file(failure))
      files.push_back(at->path());
  if (failure) throw Error(folder.string(), "cannot be read as a folder (" + failure.message() + ")");
  if (files.empty())
    throw Error(folder.string(), "holds no masks", "Put one PNG per camera there, named after it: NAME.png");
  std::ranges::sort(files);
  return files;
}

// The mask of each camera that has one.
std::map<std::size_t, fs::path> matched(const std::vector<Camera>& cameras, const fs::path& folder) {
  std::map<std::size_t, fs::path> mask_of;
  for (const fs::path& file : masks_in(folder)) {
    const fs::path relative = file.lexically_relative(folder);
    const std::string name = without_picture_ending(relative.parent_path() / relative.stem());
    const std::vector<std::size_t> found = cameras_named(cameras, name);
    if (found.empty())
      throw Error(file.string(), fmt::format("no camera is called \"{}\"", name),
                  fmt::format("There are {}, the first is \"{}\"", cameras.size(), cameras.front().name));
    if (found.size() > 1)
      throw Error(file.string(), fmt::format("{} cameras are called \"{}\"", found.size(), name),
                  "Give the pictures names that differ");
    const auto [at, first] = mask_of.emplace(found.front(), file);
    if (!first)
      throw Error(file.string(),
                  fmt::format("the camera \"{}\" has another mask, {}", cameras[found.front()].name,
                              at->second.string()),
                  "Leave one of them");
  }
  return mask_of;
}

// Hundreds of masks of large photographs are not kept whole: views are looked at much smaller.
Mask reduced(Mask mask) {
  constexpr int kKeptWidth = 1600;
  if (mask.width() <= kKeptWidth) return mask;
  return resized_mask(
      mask, kKeptWidth,
      std::max(1, static_cast<int>(static_cast<long>(mask.height()) * kKeptWidth / mask.width())));
}

}  // namespace

Mask checked_mask(Image<std::uint8_t> grey, const Camera& camera, const std::string& where) {
  if (grey.width() != camera.width_px || grey.height() != camera.height_px)
    throw Error(where,
                fmt::format("the mask is {}x{} pixels, the camera's picture {}x{}", grey.width(),
                            grey.height(), camera.width_px, camera.height_px),
                "Give --size, or another mask");
  constexpr int kBright = 128;
  const int brightest = *std::ranges::max_element(grey.pixels());
  if (brightest < kBright)
    throw Error(where,
                fmt::format("the mask is empty: white is the object, and its brightest pixel is {} of 255",
                            brightest),
                "Give a mask with white in it, or none for this camera");
  for (auto& m : grey.pixels()) m = m >= kBright ? kMaskObject : 0;
  return grey;
}

Mask read_given_mask(const fs::path& path, const Camera& camera) {
  return checked_mask(read_png_grey(path), camera, path.string());
}

MaskFolder load_mask_folder(const std::vector<Camera>& cameras, const MaskFolderOptions& options) {
  const std::map<std::size_t, fs::path> mask_of = matched(cameras, options.folder);
  const auto wanted = std::ranges::find_if(mask_of, [&](const auto& entry) {
    return options.reference && cameras[entry.first].name == *options.reference;
  });
  const std::size_t reference = wanted != mask_of.end() ? wanted->first : mask_of.begin()->first;
  MaskFolder found;
  if (options.reference && wanted == mask_of.end())
    found.warning = fmt::format("the camera \"{}\" has no mask, \"{}\" is the reference", *options.reference,
                                cameras[reference].name);
  for (const auto& [index, file] : mask_of) {
    const Camera camera =
        options.size_px ? resized(cameras[index], options.size_px->x, options.size_px->y) : cameras[index];
    Mask mask = read_given_mask(file, camera);
    if (index == reference)
      found.reference = {camera, std::move(mask)};
    else
      found.others.push_back({camera, reduced(std::move(mask))});
  }
  return found;
}

}  // namespace splatcut
