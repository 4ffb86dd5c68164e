#include "app/document/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <tuple>

#include "app/document/flag_passes.h"
#include "core/error.h"
#include "segment/finish/shown_part.h"

namespace splatcut {

namespace {

// Warm and cool in turn, apart for people who see fewer colours (after Okabe and Ito, 2008, brightened).
constexpr std::array<Rgb8, 8> kObjectColours = {Rgb8{255, 145, 40},  Rgb8{70, 180, 255}, Rgb8{40, 205, 145},
                                                Rgb8{240, 110, 190}, Rgb8{250, 225, 70}, Rgb8{150, 130, 255},
                                                Rgb8{255, 95, 80},   Rgb8{120, 220, 235}};

glm::vec3 as_shares(const Rgb8& c) {
  return glm::vec3(c[0], c[1], c[2]) / 255.0f;
}

// As different as two colours look, sRGB, 0 to 3 (Riemersma's weights by the mean of the reds).
float difference(const glm::vec3& a, const glm::vec3& b) {
  const float red = 0.5f * (a.r + b.r);
  const glm::vec3 d = a - b;
  return std::sqrt((2 + red) * d.r * d.r + 4 * d.g * d.g + (3 - red) * d.b * d.b);
}

bool none_set(const Flags& flags) {
  return !flags || std::ranges::all_of(*flags, [](std::uint8_t f) { return f == 0; });
}

bool same_flags(const Flags& a, const Flags& b) {
  if (a == b) return true;
  return a && b ? *a == *b : none_set(a) && none_set(b);
}

bool same_but_strokes(const ObjectItem& a, const ObjectItem& b) {
  const auto plain = [](const ObjectItem& o) {
    return std::tie(o.id, o.name, o.colour, o.tinted, o.locked, o.within, o.cut_key, o.cut_kept,
                    o.leaves_also);
  };
  return plain(a) == plain(b) && same_flags(a.cut, b.cut) && same_flags(a.hand, b.hand) &&
         same_flags(a.of_others, b.of_others);
}

}  // namespace

Flags make_flags(std::vector<std::uint8_t> values) {
  return std::make_shared<const std::vector<std::uint8_t>>(std::move(values));
}

const ObjectItem* Document::find(ObjectId id) const {
  if (id == 0) return nullptr;  // at once: it is asked for each Gaussian, see has()
  const auto found = std::ranges::find(objects, id, &ObjectItem::id);
  return found != objects.end() ? &*found : nullptr;
}

ObjectItem* Document::find(ObjectId id) {
  return const_cast<ObjectItem*>(std::as_const(*this).find(id));
}

CutRequest cut_request(const Document& document, const ObjectItem& object) {
  CutRequest request;
  request.strokes = object.views;
  request.left_out = object.left_out;
  request.choice = object.choice;
  request.up_world = object.up_world.value_or(document.up_world);
  request.among = object.among;
  return request;
}

CutSettings cut_settings(const Document& document, const ObjectItem& object) {
  CutSettings settings = preset(document.preset);
  settings.smoothness = object.smoothness;
  return settings;
}

Camera known_camera(const ObjectItem& object, const Camera& camera) {
  const auto known = std::ranges::find_if(
      object.views, [&](const StrokedView& view) { return same_view(view.camera, camera); });
  return known == object.views.end() ? camera : known->camera;
}

std::string cut_key(const Document& document, const ObjectItem& object) {
  const std::string smoothness = object.smoothness ? fmt::format("{}", *object.smoothness) : "its own";
  return fmt::format("{};{};", document.preset, smoothness) + key_of(cut_request(document, object));
}

std::size_t stroke_count(const ObjectItem& object) {
  std::size_t count = 0;
  for (const StrokedView& view : object.views) count += view.strokes.size();
  return count;
}

bool is_stale(const Document& document, const ObjectItem& object) {
  return is_stale(object, cut_key(document, object));
}

bool is_stale(const ObjectItem& object, const std::string& key) {
  const bool marks =
      std::ranges::any_of(object.views, [](const StrokedView& v) { return !v.strokes.empty(); });
  if (!marks) return object.cut != nullptr && !object.cut_key.empty();
  return object.cut_key != key;
}

std::vector<std::uint8_t> labels_of(const Document& document, const ObjectItem& object,
                                    std::size_t gaussians) {
  std::vector<std::uint8_t> labels = object.cut ? *object.cut : std::vector<std::uint8_t>(gaussians, 0);
  assert(labels.size() == gaussians);
  if (object.of_others) take_out_flags(*object.of_others, &labels);
  if (object.hand)
    change_each(&labels, *object.hand, [](std::uint8_t label, std::uint8_t mark) {
      return mark == kHandObject ? std::uint8_t{1} : mark == kHandRest ? std::uint8_t{0} : label;
    });
  if (document.deleted) take_out_flags(*document.deleted, &labels);
  if (const ObjectItem* whole = document.find(object.within))
    keep_flags_in(labels_of(document, *whole, gaussians), &labels);
  return labels;
}

bool has(const Document& document, const ObjectItem& object, std::size_t gaussian) {
  const auto in = [gaussian](const Flags& flags) -> std::uint8_t { return flags ? (*flags)[gaussian] : 0; };
  bool label = in(object.cut) && !in(object.of_others);
  if (const std::uint8_t mark = in(object.hand); mark == kHandObject || mark == kHandRest)
    label = mark == kHandObject;
  const ObjectItem* whole = document.find(object.within);
  return label && !in(document.deleted) && (!whole || has(document, *whole, gaussian));
}

bool is_part_of(const Document& document, const ObjectItem& part, ObjectId whole) {
  for (const ObjectItem* inner = &part; inner; inner = document.find(inner->within))
    if (inner->within == whole) return true;
  return false;
}

void set_labels(Document* document, ObjectItem* object, std::span<const std::uint8_t> labels,
                std::span<const std::uint8_t> taken_out) {
  const std::vector<std::uint8_t> before = labels_of(*document, *object, labels.size());
  std::vector<std::uint8_t> hand(labels.size(), kFollowCut);
  if (object->hand) hand = *object->hand;
  for (std::size_t g = 0; g < labels.size(); ++g)
    if ((labels[g] != 0) != (before[g] != 0)) hand[g] = labels[g] ? kHandObject : kHandRest;
  for (std::size_t g = 0; object->of_others && g < taken_out.size(); ++g) {
    const bool comes_back =
        hand[g] == kHandLeft || (hand[g] == kFollowCut && object->cut && (*object->cut)[g]);
    if (taken_out[g] && !labels[g] && (*object->of_others)[g] && comes_back) hand[g] = kHandRest;
  }
  object->hand = make_flags(std::move(hand));
}

ObjectItem& add_object(Document* document, std::string name) {
  if (document->objects.size() >= kMostObjects)
    throw Error("", fmt::format("There are {} objects already, more cannot be shown", kMostObjects),
                "Merge or remove some");
  ObjectItem object;
  object.id = document->next_id++;
  object.name = name.empty() ? fmt::format("Object {}", object.id) : std::move(name);
  const auto free = [&](const Rgb8& colour) {
    return std::ranges::find(document->objects, colour, &ObjectItem::colour) == document->objects.end();
  };
  const auto colour = [&](std::size_t after) {
    return kObjectColours[(object.id - 1 + after) % kObjectColours.size()];
  };
  std::size_t after = 0;
  while (after < kObjectColours.size() && !free(colour(after))) ++after;
  object.colour = colour(after);  // all are taken: its own again
  document->active = object.id;
  return document->objects.emplace_back(std::move(object));
}

void stand_out(Document* document, ObjectId object, const glm::vec3& under) {
  constexpr float kShows = 0.75f;
  ObjectItem& item = *document->find(object);
  const bool taken = std::ranges::any_of(document->objects, [&](const ObjectItem& other) {
    return other.id != object && other.colour == item.colour;
  });
  if (difference(as_shares(item.colour), under) >= kShows && !taken) return;
  const auto apart = [&](const Rgb8& colour) {
    float least = difference(as_shares(colour), under);
    for (const ObjectItem& other : document->objects)
      if (other.id != object) least = std::min(least, difference(as_shares(colour), as_shares(other.colour)));
    return least;
  };
  item.colour = *std::ranges::max_element(kObjectColours, {}, apart);
}

std::size_t count_flags(std::span<const std::uint8_t> flags) {
  return count_places(flags.size(), [values = flags.data()](std::size_t g) { return values[g] != 0; });
}

bool same_but_strokes(const Document& a, const Document& b) {
  const auto settings = [](const Document& d) {
    return std::tie(d.active, d.next_id, d.preset, d.up_world, d.background);
  };
  const auto same_object = [](const ObjectItem& x, const ObjectItem& y) { return same_but_strokes(x, y); };
  return settings(a) == settings(b) && same_flags(a.deleted, b.deleted) &&
         std::ranges::equal(a.objects, b.objects, same_object);
}

bool same(const Document& a, const Document& b) {
  const auto same_cut = [&](const ObjectItem& x, const ObjectItem& y) {
    return cut_key(a, x) == cut_key(b, y);
  };
  return same_but_strokes(a, b) && std::ranges::equal(a.objects, b.objects, same_cut);
}

}  // namespace splatcut
