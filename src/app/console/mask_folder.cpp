#include "app/console/mask_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "app/console/mask_file.h"
#include "core/error.h"
#include "core/lower_case.h"
#include "scene/camera/camera_names.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with('.') || name == "__MACOSX";
}

std::vector<fs::path> masks_in(const fs::path& folder) {
  constexpr std::array kEndings = {".png", ".jpg", ".jpeg", ".webp"};
  std::error_code failure;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator at(folder, failure), end; !failure && at != end;
       at.increment(failure)) {
    const bool folder_here = at->is_directory(failure);
    if (is_hidden(at->path())) {
      if (folder_here) at.disable_recursion_pending();
    } else if (std::ranges::find(kEndings, lower_case(at->path().extension().string())) != kEndings.end() &&
               at->is_regular_file(failure)) {
      files.push_back(at->path());
    }
  }
  if (failure) throw Error(folder.string(), "cannot be read as a folder (" + failure.message() + ")");
  if (files.empty())
    throw Error(folder.string(), "holds no masks",
                "Put one PNG, JPEG or WebP per camera there, named after it: NAME.png");
  std::ranges::sort(files);
  return files;
}

// The mask of each camera that has one, the masks that have no camera, and what is no mask.
struct Matches {
  std::map<std::size_t, fs::path> mask_of;
  std::vector<fs::path> others;
  std::vector<fs::path> photographs;  // of cameras that have a picture called a mask, too
};

Matches matched(const std::vector<Camera>& cameras, const fs::path& folder) {
  Matches matches;
  for (const fs::path& file : masks_in(folder)) {
    const fs::path relative = file.lexically_relative(folder);
    const std::string name = without_picture_ending(relative.parent_path() / relative.stem());
    const std::vector<std::size_t> found = cameras_of_mask(cameras, name);
    if (found.empty()) {
      matches.others.push_back(relative);
      continue;
    }
    if (found.size() > 1)
      throw Error(file.string(), fmt::format("{} cameras are called \"{}\"", found.size(), name),
                  "Give the pictures names that differ");
    const auto [at, first] = matches.mask_of.emplace(found.front(), file);
    const bool named_so = is_called_mask(file), other_named_so = is_called_mask(at->second);
    if (!first && named_so != other_named_so) {
      matches.photographs.push_back((named_so ? at->second : file).lexically_relative(folder));
      if (named_so) at->second = file;
    } else if (!first) {
      throw Error(file.string(),
                  fmt::format("the camera \"{}\" has another mask, {}", cameras[found.front()].name,
                              at->second.string()),
                  "Leave one of them");
    }
  }
  if (matches.mask_of.empty())
    throw Error((folder / matches.others.front()).string(),
                fmt::format("no camera is called \"{}\"", matches.others.front().stem().string()),
                fmt::format("There are {}, the first is \"{}\"", cameras.size(), cameras.front().name));
  return matches;
}

// Hundreds of masks of large photographs are not kept whole: views are looked at much smaller.
Mask reduced(Mask mask) {
  constexpr int kKeptWidth = 1600;
  if (mask.width() <= kKeptWidth) return mask;
  return resized_mask(
      mask, kKeptWidth,
      std::max(1, static_cast<int>(static_cast<long>(mask.height()) * kKeptWidth / mask.width())));
}

bool same_aspect(const Mask& mask, const Camera& camera) {
  const std::int64_t across = std::int64_t{mask.width()} * camera.height_px,
                     down = std::int64_t{mask.height()} * camera.width_px;
  constexpr std::int64_t kMostShare = 20;  // a twentieth: of a few pixels, one of rounding is any shape
  return std::abs(across - down) <=
         std::min<std::int64_t>(std::max({mask.width(), mask.height(), camera.width_px,
                                          camera.height_px}),  // a pixel of rounding
                                std::max(across, down) / kMostShare);
}

Mask in_size_of(Mask mask, const Camera& camera, const std::string& where) {
  if (mask.width() == camera.width_px && mask.height() == camera.height_px) return mask;
  if (!same_aspect(mask, camera))
    throw Error(where,
                fmt::format("the mask is {}x{} pixels, the camera's picture {}x{}", mask.width(),
                            mask.height(), camera.width_px, camera.height_px),
                "Give --size, or another mask");
  return resized_mask(mask, camera.width_px, camera.height_px);
}

// How the masks of a folder were understood, one sentence for all.
class Understood {
 public:
  void add(const ReadMask& mask, const Camera& camera) {
    if (mask.how.empty())
      ++black_;
    else
      how_.insert(mask.how);
    if (mask.mask.width() != camera.width_px)
      scales_.insert(
          fmt::format("scaled by {:.3g}", static_cast<double>(camera.width_px) / mask.mask.width()));
  }
  std::string sentence(const Matches& matches) const {
    const std::size_t with = matches.mask_of.size(), all = with + matches.others.size();
    std::string text = fmt::format("{} of {} mask{} {} a camera", with, all, all == 1 ? "" : "s",
                                   with == 1 ? "has" : "have");
    if (!how_.empty()) text += fmt::format("; taken for the object: {}", fmt::join(how_, " or "));
    for (const std::string& scale : scales_) text += "; " + scale;
    if (black_ > 0) text += fmt::format("; {} black: there all is rest", black_);
    return text;
  }

 private:
  std::set<std::string> how_, scales_;
  std::size_t black_ = 0;
};

// Sentences on what was left out.
std::vector<std::string> left_out(const Matches& matches) {
  std::vector<std::string> sentences;
  const auto add = [&](const std::vector<fs::path>& files, const char* one, const char* several) {
    const std::size_t count = files.size();
    if (count == 1) sentences.push_back(fmt::format("1 {} left out: \"{}\"", one, files.front().string()));
    if (count > 1)
      sentences.push_back(
          fmt::format("{} {} left out, \"{}\" among them", count, several, files.front().string()));
  };
  add(matches.others, "mask has no camera and is", "masks have no camera and are");
  add(matches.photographs, "picture lies beside the mask of its camera and is",
      "pictures lie beside the mask of their camera and are");
  return sentences;
}

}  // namespace

Mask checked_mask(ReadMask read, const Camera& camera, const std::string& where) {
  if (read.how.empty())
    throw Error(where, "the mask is empty: all of it is black",
                "Give a mask in which the object is white, or none for this camera");
  return in_size_of(std::move(read.mask), camera, where);
}

MaskFolder load_mask_folder(const std::vector<Camera>& cameras, const MaskFolderOptions& options) {
  const Matches matches = matched(cameras, options.folder);
  MaskFolder found;
  Understood understood;
  std::vector<GivenView> views;
  std::optional<std::size_t> reference;
  for (const auto& [index, file] : matches.mask_of) {
    const Camera camera =
        options.size_px ? resized(cameras[index], options.size_px->x, options.size_px->y) : cameras[index];
    ReadMask read = read_mask(file);
    understood.add(read, camera);
    const bool wanted = options.reference && cameras[index].name == *options.reference;
    if (!read.how.empty() && (!reference || wanted)) reference = views.size();
    views.push_back({camera, in_size_of(std::move(read.mask), camera, file.string())});
    const bool kept_whole = reference == views.size() - 1;
    if (!kept_whole) views.back().mask = reduced(std::move(views.back().mask));
  }
  if (!reference)
    throw Error(options.folder.string(), "all masks are black",
                "Give at least one mask in which the object is white");
  found.reference = std::move(views[*reference]);
  views.erase(views.begin() + static_cast<std::ptrdiff_t>(*reference));
  for (GivenView& view : views) view.mask = reduced(std::move(view.mask));
  found.others = std::move(views);
  found.how = understood.sentence(matches);
  found.warnings = left_out(matches);
  if (options.reference && found.reference.camera.name != *options.reference)
    found.warnings.push_back(fmt::format("the camera \"{}\" has no mask, \"{}\" is the reference",
                                         *options.reference, found.reference.camera.name));
  return found;
}

}  // namespace splatcut
