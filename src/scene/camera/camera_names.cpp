#include "scene/camera/camera_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <set>
#include <string_view>

#include "core/error.h"
#include "core/lower_case.h"
#include "scene/camera/plain_letters.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

// With / alone, and what follows a folder `images`, if there is one.
std::string path_below_images(std::string name) {
  std::ranges::replace(name, '\\', '/');
  constexpr std::string_view kImages = "images";
  for (std::size_t begin = 0, end = 0; (end = name.find('/', begin)) != name.npos; begin = end + 1)
    if (name.compare(begin, end - begin, kImages) == 0) return name.substr(end + 1);
  while (name.starts_with("./")) name.erase(0, 2);
  return name;
}

std::string file_part(const std::string& name) {
  return name.substr(name.rfind('/') + 1);  // npos + 1 is 0
}

bool ends_as_path(const std::string& path, const std::string& tail) {
  return path.ends_with(tail) && (path.size() == tail.size() || path[path.size() - tail.size() - 1] == '/');
}

using Key = std::function<std::string(const std::string&)>;

std::vector<std::size_t> alike(const std::vector<Camera>& cameras, const std::string& name, const Key& key) {
  const std::string wanted = key(without_picture_ending(path_below_images(name)));
  std::vector<std::size_t> whole, tail, file_only;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const std::string camera = key(without_picture_ending(path_below_images(cameras[c].name)));
    if (camera.empty()) continue;
    if (camera == wanted) whole.push_back(c);
    if (ends_as_path(camera, wanted) || ends_as_path(wanted, camera)) tail.push_back(c);
    if (file_part(camera) == file_part(wanted)) file_only.push_back(c);
  }
  return !whole.empty() ? whole : !tail.empty() ? tail : file_only;
}

std::string itself(const std::string& name) {
  return name;
}

// The last number of the file's name without zeros before it.
std::string with_short_number(const std::string& name) {
  const std::size_t last = name.find_last_of("0123456789");
  if (last == name.npos) return name;
  std::size_t first = last;
  while (first > 0 && std::isdigit(static_cast<unsigned char>(name[first - 1]))) --first;
  const std::size_t number = std::min(name.find_first_not_of('0', first), last);
  return name.substr(0, first) + name.substr(number);
}

std::string without_mask_ending(const std::string& name) {
  for (const std::string_view ending :
       {"_mask", "-mask", ".mask", "_masks", "_seg", "_segmentation", "_alpha", "_matte"})
    if (lower_case(name).ends_with(ending)) return name.substr(0, name.size() - ending.size());
  const std::size_t file = name.rfind('/') + 1;  // npos + 1 is 0
  constexpr std::string_view kBegin = "mask_";
  return lower_case(name).compare(file, kBegin.size(), kBegin) == 0
             ? name.substr(0, file) + name.substr(file + kBegin.size())
             : name;
}

bool is_number(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c); }) &&
         (name == "0" || name[0] != '0');
}

}  // namespace

std::string without_picture_ending(const fs::path& name) {
  constexpr std::array kEndings = {".png",  ".jpg", ".jpeg", ".tif", ".tiff",
                                   ".webp", ".bmp", ".exr",  ".heic"};
  if (std::ranges::find(kEndings, lower_case(name.extension().string())) == kEndings.end())
    return name.string();
  return (name.parent_path() / name.stem()).string();
}

void name_after_pictures(std::vector<Camera>* cameras) {
  std::set<std::string> short_names;
  for (Camera& camera : *cameras) {
    camera.name = without_picture_ending(path_below_images(camera.name));
    short_names.insert(file_part(camera.name));
  }
  if (short_names.size() < cameras->size()) return;
  for (Camera& camera : *cameras) camera.name = file_part(camera.name);
}

std::vector<std::size_t> cameras_named(const std::vector<Camera>& cameras, const std::string& name) {
  const std::vector<std::size_t> found = alike(cameras, name, itself);
  return found.empty() ? alike(cameras, name, lower_case) : found;
}

std::vector<std::size_t> cameras_of_mask(const std::vector<Camera>& cameras, const std::string& name) {
  const std::string bare = without_mask_ending(without_picture_ending(name));
  const Key short_and_plain = [](const std::string& n) {
    return lower_case(with_short_number(without_accents(n)));
  };
  for (const Key& key :
       {Key(itself), Key([](const std::string& n) { return without_accents(n); }), Key(short_and_plain)})
    for (const std::string& tried : {name, bare})
      if (std::vector<std::size_t> found = alike(cameras, tried, key); !found.empty()) return found;
  return {};
}

bool is_called_mask(const fs::path& picture) {
  const std::string name = without_picture_ending(without_picture_ending(picture.filename()));
  return without_mask_ending(name) != name;
}

const Camera& find_camera(const std::vector<Camera>& cameras, const std::string& name,
                          const std::string& where) {
  const auto named = std::ranges::find(cameras, name, &Camera::name);
  if (std::ranges::count(cameras, name, &Camera::name) == 1) return *named;
  const std::vector<std::size_t> found = cameras_named(cameras, name);
  if (found.size() == 1) return cameras[found.front()];
  if (found.size() > 1)
    throw Error(where, fmt::format("has {} cameras that \"{}\" can mean", found.size(), name),
                fmt::format("The first is \"{}\", number {}: give the whole name or the number",
                            cameras[found.front()].name, found.front()));
  std::size_t index = cameras.size();
  if (is_number(name)) std::from_chars(name.data(), name.data() + name.size(), index);
  if (index < cameras.size()) return cameras[index];
  if (cameras.empty()) throw Error(where, fmt::format("names the camera \"{}\", but has no cameras", name));
  throw Error(where, fmt::format("has no camera \"{}\"", name),
              fmt::format("It has {}, the first is \"{}\"", cameras.size(), cameras.front().name));
}

}  // namespace splatcut
