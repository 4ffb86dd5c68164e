#include "segment/session/cut_request.h"

#include <algorithm>
#include <mutex>
#include <span>
#include <string_view>
#include <type_traits>
#include <unordered_map>

#include "core/byte_hash.h"

namespace splatcut {

namespace {

// Keys of a whole history hold the same few arrays again and again, which never change: each is read once.
std::uint64_t hash_of(const SeenGaussians& seen) {
  struct Known {
    SeenGaussians::weak_type array;
    std::uint64_t hash = 0;
  };
  static std::mutex mutex;
  static std::unordered_map<const void*, Known> known;  // by address, which is not used again before
  const std::lock_guard lock(mutex);
  Known& one = known[seen.get()];
  if (one.array.lock() == seen) return one.hash;
  one = {seen, hash_bytes(std::as_bytes(std::span(*seen)))};
  const std::uint64_t hash = one.hash;
  constexpr std::size_t kMostKnown = 1024;
  if (known.size() > kMostKnown) std::erase_if(known, [](const auto& k) { return k.second.array.expired(); });
  return hash;
}

// Bytes in which every list says its length first, so that no two requests share them.
class Key {
 public:
  template <class Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  void numbers(std::span<const float> values) {
    for (const float value : values) number(value);
  }
  template <class List, class Add>
  void list(const List& list, const Add& add) {
    number(std::uint64_t{list.size()});
    for (const auto& item : list) add(item);
  }
  void camera(const Camera& c) {
    for (const int v : {c.width_px, c.height_px}) number(v);
    for (const float v : {c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.most_near_plane}) number(v);
    numbers({&c.camera_from_world_rotation[0][0], 9});
    numbers({&c.camera_from_world_translation.x, 3});
  }
  void cameras(const std::vector<Camera>& cameras) {
    list(cameras, [this](const Camera& c) { camera(c); });
  }
  void strokes(const Strokes& strokes) {
    list(strokes, [this](const Stroke& stroke) {
      number(stroke.kind);
      number(stroke.label);
      number(stroke.radius_px);
      number(stroke.size_step);
      list(stroke.points_px, [this](const glm::vec2& p) { numbers({&p.x, 2}); });
    });
  }
  void seen(const SeenGaussians& seen) {
    number(seen != nullptr);
    if (seen) number(hash_of(seen));
  }
  void stroked(const StrokedView& view) {
    camera(view.camera);
    strokes(view.strokes);
    seen(view.seen);
  }
  void given(const GivenView& view) {
    camera(view.camera);
    number(view.mask.width());
    number(view.mask.height());
    number(hash_bytes(std::as_bytes(view.mask.pixels())));
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// All but the strokes and the views left out.
void add_given(const CutRequest& request, Key* key) {
  key->number(request.first_mask.has_value());
  if (request.first_mask) key->given(*request.first_mask);
  key->list(request.masks, [key](const GivenView& view) { key->given(view); });
  key->number(static_cast<bool>(request.mask_source));
  key->cameras(request.views);
  key->number(request.choice);
  key->number(request.up_world.has_value());
  if (request.up_world) key->numbers({&request.up_world->x, 3});
  key->seen(request.among);
  key->number(std::uint64_t{request.carried.strokes});
  key->seen(request.carried.labels);
}

}  // namespace

std::size_t stroke_count(const CutRequest& request) {
  std::size_t count = 0;
  for (const StrokedView& view : request.strokes) count += view.strokes.size();
  return count;
}

std::vector<StrokedView> strokes_by_view(const std::vector<StrokedView>& strokes) {
  std::vector<StrokedView> views;
  for (const StrokedView& entry : strokes) {
    const auto known = std::ranges::find_if(
        views, [&](const StrokedView& view) { return same_view(view.camera, entry.camera); });
    if (known == views.end())
      views.push_back(entry);
    else
      known->strokes.insert(known->strokes.end(), entry.strokes.begin(), entry.strokes.end());
  }
  return views;
}

bool marks_object(const StrokedView& view) {
  return std::ranges::any_of(view.strokes, [](const Stroke& s) { return s.label == SeedLabel::kObject; });
}

Stroke* first_stroke(std::vector<StrokedView>* strokes) {
  for (StrokedView& view : *strokes)
    for (Stroke& stroke : view.strokes)
      if (stroke.label == SeedLabel::kObject) return &stroke;
  return nullptr;
}

Stroke* last_stroke(std::vector<StrokedView>* strokes) {
  if (!first_stroke(strokes)) return nullptr;
  Stroke* last = nullptr;
  for (StrokedView& view : *strokes)
    if (!view.strokes.empty()) last = &view.strokes.back();
  return last;
}

const Stroke* first_stroke(const std::vector<StrokedView>& strokes) {
  return first_stroke(const_cast<std::vector<StrokedView>*>(&strokes));
}

const Stroke* last_stroke(const std::vector<StrokedView>& strokes) {
  return last_stroke(const_cast<std::vector<StrokedView>*>(&strokes));
}

bool last_takes_away(const std::vector<StrokedView>& strokes) {
  const Stroke* last = last_stroke(strokes);
  return last && last->label == SeedLabel::kRest;
}

void set_size_steps(std::span<const int> steps, std::vector<StrokedView>* strokes) {
  std::vector<Stroke*> order;
  for (StrokedView& view : *strokes)
    for (Stroke& stroke : view.strokes) order.push_back(&stroke);
  const auto first = std::ranges::find(order, first_stroke(strokes));
  if (first != order.end()) std::rotate(order.begin(), first, first + 1);
  for (std::size_t i = 0; i < std::min(order.size(), steps.size()); ++i) order[i]->size_step = steps[i];
}

std::optional<ReferenceView> reference_of(const CutRequest& request,
                                          const std::vector<StrokedView>& by_view) {
  if (request.first_mask) return ReferenceView{request.first_mask->camera, {}};
  const auto reference = std::ranges::find_if(by_view, marks_object);
  if (reference == by_view.end()) return std::nullopt;
  return ReferenceView{reference->camera, reference->strokes};
}

std::string key_of(const CutRequest& request) {
  Key key;
  key.list(request.strokes, [&key](const StrokedView& view) { key.stroked(view); });
  key.list(request.left_out, [&key](Camera view) {  // told apart by same_view() alone
    view.most_near_plane = Camera().most_near_plane;
    key.camera(view);
  });
  add_given(request, &key);
  return key.take();
}

std::string key_of_strokes(const CutRequest& request) {
  Key key;
  key.list(request.strokes, [&key](const StrokedView& view) { key.stroked(view); });
  return key.take();
}

std::string key_of_first_stroke(const CutRequest& request) {
  for (const StrokedView& view : request.strokes)
    for (const Stroke& stroke : view.strokes) {
      if (stroke.label != SeedLabel::kObject) continue;
      Key key;
      Stroke alone = stroke;
      alone.size_step = 0;
      key.stroked({view.camera, {alone}, view.seen});
      key.seen(request.among);
      return key.take();
    }
  return {};
}

std::string key_of_last_stroke(const CutRequest& request) {
  CutRequest own_size;
  own_size.strokes = request.strokes;
  own_size.choice = request.choice;
  own_size.among = request.among;
  Stroke* last = last_stroke(&own_size.strokes);
  if (!last) return {};
  last->size_step = 0;
  return key_of(own_size);
}

std::string key_of_reference(const CutRequest& request, const ReferenceView& reference) {
  Key key;
  key.camera(reference.camera);
  key.strokes(reference.strokes);
  add_given(request, &key);
  return key.take();
}

}  // namespace splatcut
