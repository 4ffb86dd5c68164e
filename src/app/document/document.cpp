#include "app/document/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <tuple>

#include "app/document/label_cache.h"
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

// Changes each byte by the one of the same place. The compiler takes 16 at a time where the change is no
// branch: the window waits for these passes.
template <class Change>
void change_each(std::vector<std::uint8_t>* bytes, const std::vector<std::uint8_t>& by, Change change) {
  assert(bytes->size() == by.size());
  std::uint8_t* to = bytes->data();
  const std::uint8_t* from = by.data();
  const std::size_t n = bytes->size();
  for (std::size_t g = 0; g < n; ++g) to[g] = change(to[g], from[g]);
}

using Byte = std::uint8_t;
void add(const std::vector<Byte>& flags, std::vector<Byte>* to) {
  change_each(to, flags, [](Byte a, Byte b) { return static_cast<Byte>(a | b); });
}
void take_out(const std::vector<Byte>& flags, std::vector<Byte>* of) {
  change_each(of, flags, [](Byte a, Byte b) { return b != 0 ? Byte{0} : a; });
}
void keep_in(const std::vector<Byte>& flags, std::vector<Byte>* of) {
  change_each(of, flags, [](Byte a, Byte b) { return b != 0 ? a : Byte{0}; });
}

// How many of n places something holds for. A byte counts to 255, and 16 of them count at a time.
template <class Holds>
std::size_t count_places(std::size_t n, Holds holds) {
  constexpr std::size_t kMost = 255;
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < n; begin += kMost) {
    const std::size_t end = std::min(n, begin + kMost);
    Byte some = 0;
    for (std::size_t g = begin; g < end; ++g) some = static_cast<Byte>(some + holds(g));
    count += some;
  }
  return count;
}

std::size_t count_both(const std::vector<Byte>& a, const std::vector<Byte>& b) {
  return count_places(a.size(), [x = a.data(), y = b.data()](std::size_t g) { return (x[g] & y[g]) != 0; });
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

// Whether that holds for more than half of what a stroke hits.
template <class Holds>
bool holds_for_most(std::span<const std::int32_t> hits, Holds holds) {
  const auto on =
      std::ranges::count_if(hits, [&](std::int32_t g) { return holds(static_cast<std::size_t>(g)); });
  return 2 * on > std::ssize(hits);
}

// The same of flags. Null: no flags.
bool is_made_on(const Flags& flags, std::span<const std::int32_t> hits) {
  return flags && holds_for_most(hits, [&](std::size_t g) { return (*flags)[g] != 0; });
}

// Whether the one can leave the other anything: neither is a part of the other.
bool are_apart(const Document& document, const ObjectItem& a, const ObjectItem& b) {
  return a.id != b.id && !is_part_of(document, a, b.id) && !is_part_of(document, b, a.id);
}

// What those of the other objects have that are asked for, but for parts of this one and wholes of it.
template <class IsAsked>
Flags had_by(const Document& document, const ObjectItem& object, std::size_t gaussians, LabelCache* known,
             IsAsked is_asked) {
  std::vector<std::uint8_t> had(gaussians, 0);
  for (const ObjectItem& other : document.objects) {
    if (!is_asked(other) || !are_apart(document, object, other)) continue;
    add(*known_labels(document, other, gaussians, known), &had);
  }
  return count_flags(had) > 0 ? make_flags(std::move(had)) : nullptr;
}

bool holds(std::span<const ObjectId> ids, ObjectId id) {
  return std::ranges::find(ids, id) != ids.end();
}

// Sets ObjectItem::of_others. What hands had taken of what is left no more is the object's again; what they
// took of what is left now is left, too, but where they took it later.
void set_left(ObjectItem* object, Flags of_others, bool hands_are_later) {
  object->of_others = std::move(of_others);
  if (!object->hand) return;
  std::vector<std::uint8_t> hand = *object->hand;
  for (std::size_t g = 0; g < hand.size(); ++g) {
    const bool is_left = object->of_others && (*object->of_others)[g];
    if (hand[g] == kHandLeft && !is_left) hand[g] = kHandObject;
    if (hand[g] == kHandObject && is_left && !hands_are_later) hand[g] = kHandLeft;
  }
  if (hand != *object->hand) object->hand = make_flags(std::move(hand));
}

// share_what_is_hit() with those alone of `only`, if there are any.
void share_with(const Document& document, ObjectItem* object, std::span<const std::int32_t> hits,
                std::size_t gaussians, std::span<const ObjectId> only, LabelCache* known) {
  std::vector<std::uint8_t> left = *object->of_others, had(gaussians, 0), shared = had, stays = had;
  std::vector<ObjectId> hit;
  for (const ObjectItem& other : document.objects) {  // parts behind their wholes
    if (!are_apart(document, *object, other)) continue;
    const Flags labels = known_labels(document, other, gaussians, known);
    const auto is_left = [&](std::size_t g) { return (*labels)[g] && left[g]; };
    const bool is_hit =
        !other.locked && (holds(hit, other.within) ||
                          ((only.empty() || holds(only, other.id)) && holds_for_most(hits, is_left)));
    if (is_hit) hit.push_back(other.id);
    add(*labels, &had);
    if (is_hit)
      add(*labels, &shared);
    else if (other.locked || 2 * count_both(*labels, left) > count_flags(*labels))
      add(*labels, &stays);  // of one that it shared with before, it leaves only what others have, too
  }
  if (hit.empty() && !only.empty()) return;
  if (hit.empty()) {
    keep_in(had, &left);
  } else {
    take_out(stays, &shared);
    take_out(shared, &left);
  }
  std::erase_if(object->leaves_also, [&](ObjectId id) { return holds(hit, id); });
  set_left(object, count_flags(left) > 0 ? make_flags(std::move(left)) : nullptr, true);
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
  if (object.of_others) take_out(*object.of_others, &labels);
  if (object.hand)
    change_each(&labels, *object.hand, [](Byte label, Byte mark) {
      return mark == kHandObject ? Byte{1} : mark == kHandRest ? Byte{0} : label;
    });
  if (document.deleted) take_out(*document.deleted, &labels);
  if (const ObjectItem* whole = document.find(object.within))
    keep_in(labels_of(document, *whole, gaussians), &labels);
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

Flags had_by_others(const Document& document, const ObjectItem& object, std::size_t gaussians, ObjectId only,
                    LabelCache* known) {
  return had_by(document, object, gaussians, known,
                [&](const ObjectItem& other) { return only == 0 || other.id == only; });
}

Flags kept_by_locked(const Document& document, const ObjectItem& object, std::size_t gaussians,
                     LabelCache* known) {
  const Flags had = had_by(document, object, gaussians, known, [](const ObjectItem& o) { return o.locked; });
  if (!had) return nullptr;
  std::vector<std::uint8_t> kept = *had;
  take_out(*known_labels(document, object, gaussians, known), &kept);
  return count_flags(kept) > 0 ? make_flags(std::move(kept)) : nullptr;
}

void leave_to_locked(const Document& document, ObjectItem* object, std::size_t gaussians, LabelCache* known) {
  const Flags kept = kept_by_locked(document, *object, gaussians, known);
  if (!kept) return;
  std::vector<std::uint8_t> left = *kept;
  if (object->of_others) add(*object->of_others, &left);
  if (!object->of_others || left != *object->of_others) object->of_others = make_flags(std::move(left));
}

void leave_to_locked_one(Document* document, const ObjectItem& locked, std::size_t gaussians) {
  const std::vector<std::uint32_t> rows = labelled_rows(labels_of(*document, locked, gaussians));
  for (ObjectItem& other : document->objects) {
    if (!are_apart(*document, locked, other)) continue;
    std::vector<std::uint8_t> left;
    for (const std::uint32_t g : rows) {
      if ((other.of_others && (*other.of_others)[g]) || has(*document, other, g)) continue;
      if (left.empty()) left = other.of_others ? *other.of_others : std::vector<std::uint8_t>(gaussians, 0);
      left[g] = 1;
    }
    if (!left.empty()) other.of_others = make_flags(std::move(left));
  }
}

const ObjectItem* locked_under(const Document& document, const ObjectItem& object,
                               std::span<const std::int32_t> hits) {
  std::vector<const ObjectItem*> keepers;
  for (const ObjectItem& other : document.objects)
    if (other.locked && are_apart(document, object, other)) keepers.push_back(&other);
  const auto is_kept = [&](std::size_t g) {
    return !has(document, object, g) &&
           std::ranges::any_of(keepers, [&](const ObjectItem* other) { return has(document, *other, g); });
  };
  if (keepers.empty() || !holds_for_most(hits, is_kept)) return nullptr;
  const auto has_most = [&](const ObjectItem* other) {
    return holds_for_most(hits, [&](std::size_t g) { return has(document, *other, g); });
  };
  const auto found = std::ranges::find_if(keepers, has_most);
  return found != keepers.end() ? *found : nullptr;
}

bool is_without_others(const Document& document, const ObjectItem& object, std::size_t gaussians,
                       LabelCache* known) {
  if (!object.of_others) return false;
  for (std::size_t g = 0; object.hand && g < object.hand->size(); ++g)
    if ((*object.hand)[g] == kHandObject && (*object.of_others)[g]) return false;
  const Flags kept = kept_by_locked(document, object, gaussians, known);
  if (!kept) return true;
  for (std::size_t g = 0; g < gaussians; ++g)
    if ((*object.of_others)[g] && !(*kept)[g]) return true;
  return false;
}

void set_of_others(ObjectItem* object, Flags of_others) {
  set_left(object, std::move(of_others), false);
  object->leaves_also.clear();
}

void set_left_earlier(ObjectItem* object, Flags of_others) {
  set_left(object, std::move(of_others), true);
}

void share_again(const Document& document, ObjectItem* object, std::size_t gaussians, LabelCache* known) {
  set_of_others(object, kept_by_locked(document, *object, gaussians, known));
}

void share_what_is_hit(const Document& document, ObjectItem* object, std::span<const std::int32_t> hits,
                       std::size_t gaussians, LabelCache* known) {
  share_with(document, object, hits, gaussians, {}, known);
}

void leave_to_others(const Document& document, ObjectItem* object, std::size_t gaussians, LabelCache* known) {
  set_of_others(object, had_by_others(document, *object, gaussians, 0, known));
  for (const ObjectItem& other : document.objects)
    if (other.id != object->id && is_stale(document, other)) object->leaves_also.push_back(other.id);
}

bool reaches_beyond(const ObjectItem& object, std::span<const std::int32_t> hits) {
  return object.among && !hits.empty() && !is_made_on(object.among, hits);
}

bool means_what_is_left(const Document& document, const ObjectItem& object,
                        std::span<const std::int32_t> hits) {
  if (!is_made_on(object.of_others, hits)) return false;
  if (hits.size() == 1) return true;  // whoever has it
  std::vector<std::uint8_t> is_anothers(hits.size(), 0);
  for (const ObjectItem& other : document.objects) {
    if (!are_apart(document, object, other)) continue;
    std::size_t count = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const auto g = static_cast<std::size_t>(hits[i]);
      if (!(*object.of_others)[g] || !has(document, other, g)) continue;
      is_anothers[i] = 1;
      ++count;
    }
    if (2 * count > hits.size()) return true;
  }
  std::size_t nobodys = 0;  // what no other has any more
  for (std::size_t i = 0; i < hits.size(); ++i)
    nobodys += (*object.of_others)[static_cast<std::size_t>(hits[i])] && !is_anothers[i];
  return 2 * nobodys > hits.size();
}

ObjectItem left_what_came(const Document& document, const ObjectItem& object, std::span<const ObjectId> came,
                          const HitsOfStrokes& hits, std::size_t gaussians, LabelCache* known) {
  ObjectItem out = object;
  std::erase_if(out.leaves_also, [&](ObjectId id) { return holds(came, id); });
  std::vector<Flags> had, may_be_shared;
  for (const ObjectId id : came)
    if (Flags of_one = had_by_others(document, object, gaussians, id, known)) {
      if (!document.find(id)->locked) may_be_shared.push_back(of_one);
      had.push_back(std::move(of_one));
    }
  if (had.empty()) return out;
  std::vector<std::uint8_t> all(gaussians, 0);
  if (out.of_others) all = *out.of_others;
  for (const Flags& of_one : had) add(*of_one, &all);
  set_left_earlier(&out, make_flags(std::move(all)));
  if (may_be_shared.empty()) return out;
  for (const std::vector<std::int32_t>& of_stroke : hits()) {
    const auto is_meant = [&](const Flags& of_one) { return is_made_on(of_one, of_stroke); };
    if (out.of_others && std::ranges::any_of(may_be_shared, is_meant))
      share_with(document, &out, of_stroke, gaussians, came, known);
  }
  return out;
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
