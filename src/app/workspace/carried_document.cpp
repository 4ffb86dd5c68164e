#include "app/workspace/carried_document.h"

#include <algorithm>

namespace splatcut {

namespace {

constexpr std::int32_t kNotSeen = -2;  // in keys of arrays that are no views

// By row of the scene: which file it is of.
std::vector<std::int32_t> file_of_rows(const std::vector<SceneSource>& files) {
  std::vector<std::int32_t> of;
  for (std::size_t i = 0; i < files.size(); ++i)
    of.insert(of.end(), files[i].file_rows, static_cast<std::int32_t>(i));
  return of;
}

std::vector<std::int32_t> gaussian_of_rows(const OpenedScene& scene) {
  std::vector<std::int32_t> of(scene.scene->file_rows, -1);
  for (std::size_t g = 0; g < scene.cloud->size(); ++g)
    of[scene.cloud->file_row[g]] = static_cast<std::int32_t>(g);
  return of;
}

std::size_t first_row(const std::vector<SceneSource>& files, std::size_t file) {
  std::size_t rows = 0;
  for (std::size_t i = 0; i < file; ++i) rows += files[i].file_rows;
  return rows;
}

}  // namespace

CarriedDocument::CarriedDocument(const OpenedScene& before, const OpenedScene& after)
    : gaussians_before_(before.cloud->size()),
      drawn_before_(drawn_part_of(before.cloud, before.blocks)),
      before_of_(after.cloud->size(), kNew),
      file_of_(after.cloud->size()) {
  const std::vector<std::int32_t> file_of = file_of_rows(after.files), was = gaussian_of_rows(before);
  std::vector<std::int64_t> shift(after.files.size(), 0);  // from a row now to the row it was
  std::vector<bool> known(after.files.size(), false);
  files_.resize(after.files.size());
  for (std::size_t i = 0; i < after.files.size(); ++i) {
    const auto source = std::ranges::find(before.files, after.files[i].id, &SceneSource::id);
    if (source == before.files.end()) continue;
    known[i] = true;
    files_[i] = {source->place != after.files[i].place, similarity_between(*source, after.files[i])};
    shift[i] = static_cast<std::int64_t>(
                   first_row(before.files, static_cast<std::size_t>(source - before.files.begin()))) -
               static_cast<std::int64_t>(first_row(after.files, i));
  }
  for (std::size_t g = 0; g < before_of_.size(); ++g) {
    const std::uint32_t row = after.cloud->file_row[g];
    file_of_[g] = file_of[row];
    const auto file = static_cast<std::size_t>(file_of_[g]);
    if (known[file]) before_of_[g] = was[static_cast<std::size_t>(row + shift[file])];
  }
}

Flags CarriedDocument::carried(const Flags& flags) {
  if (!flags) return nullptr;
  Flags& known = known_[{flags, kNotSeen}];
  if (known) return known;
  std::vector<std::uint8_t> out(before_of_.size(), 0);
  for (std::size_t g = 0; g < out.size(); ++g)
    if (before_of_[g] != kNew) out[g] = (*flags)[static_cast<std::size_t>(before_of_[g])];
  return known = make_flags(std::move(out));
}

// only_file: kAnyFile: all that have not moved.
Flags CarriedDocument::seen(const Flags& flags, std::int32_t only_file) {
  Flags& known = known_[{flags, only_file}];
  if (known) return known;
  std::vector<std::uint8_t> out(before_of_.size(), 0);
  for (std::size_t g = 0; g < out.size(); ++g) {
    const bool counts = only_file == kAnyFile ? !files_[static_cast<std::size_t>(file_of_[g])].moved
                                              : file_of_[g] == only_file;
    if (before_of_[g] != kNew && counts)
      out[g] = flags ? (*flags)[static_cast<std::size_t>(before_of_[g])] : 1;
  }
  return known = make_flags(std::move(out));
}

// As flags of the old scene.
const Flags& CarriedDocument::hit_by_first_stroke(const ObjectItem& object) {
  Flags& known = hit_[key_of_first_stroke(cut_request({}, object))];
  if (known) return known;
  std::vector<std::uint8_t> hit(gaussians_before_, 0);
  const auto view = std::ranges::find_if(object.views, marks_object);
  if (view != object.views.end()) {
    const Stroke& first = *std::ranges::find(view->strokes, SeedLabel::kObject, &Stroke::label);
    for (const std::int32_t g : hits_of({view->camera, first, view->seen}, drawn_before_))
      hit[static_cast<std::size_t>(g)] = 1;
  }
  return known = make_flags(std::move(hit));
}

std::int32_t CarriedDocument::followed_file(const ObjectItem& object) {
  if (std::ranges::none_of(files_, &File::moved) || (!object.cut && object.views.empty())) return kAnyFile;
  const Flags& has = object.cut ? object.cut : hit_by_first_stroke(object);
  const auto [known, fresh] = followed_.try_emplace(has, kAnyFile);
  if (!fresh) return known->second;
  std::vector<std::size_t> count(files_.size(), 0);
  std::size_t all = 0;
  for (std::size_t g = 0; g < before_of_.size(); ++g)
    if (before_of_[g] != kNew && (*has)[static_cast<std::size_t>(before_of_[g])]) {
      ++count[static_cast<std::size_t>(file_of_[g])];
      ++all;
    }
  for (std::size_t i = 0; i < files_.size(); ++i)
    if (files_[i].moved && 2 * count[i] > all) known->second = static_cast<std::int32_t>(i);
  return known->second;
}

void CarriedDocument::carry_views(ObjectItem* object) {
  const std::int32_t followed = followed_file(*object);
  for (StrokedView& view : object->views) view.seen = seen(view.seen, followed);
  if (!object->views.empty()) object->among = seen(object->among, followed);
  if (followed == kAnyFile) return;
  const Similarity& to = files_[static_cast<std::size_t>(followed)].to;
  for (StrokedView& view : object->views) view.camera = moved(view.camera, to);
  for (Camera& camera : object->left_out) camera = moved(camera, to);
  if (object->up_world) object->up_world = to.rotation * *object->up_world;
}

Document CarriedDocument::operator()(const Document& document) {
  Document out = document;
  out.deleted = carried(document.deleted);
  for (ObjectItem& object : out.objects) {
    const bool current = object.cut && !object.views.empty() && !is_stale(document, object);
    carry_views(&object);
    object.cut = carried(object.cut);
    object.hand = carried(object.hand);
    object.of_others = carried(object.of_others);
    if (!current) continue;
    object.cut_key = cut_key(out, object);
    object.cut_kept = true;
  }
  return out;
}

}  // namespace splatcut
