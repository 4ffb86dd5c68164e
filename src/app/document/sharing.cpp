// What objects leave to each other, and share.
#include <algorithm>

#include "app/document/document.h"
#include "app/document/flag_passes.h"
#include "app/document/label_cache.h"

namespace splatcut {

namespace {

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
    add_flags(*known_labels(document, other, gaussians, known), &had);
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
    add_flags(*labels, &had);
    if (is_hit)
      add_flags(*labels, &shared);
    else if (other.locked || 2 * count_both(*labels, left) > count_flags(*labels))
      add_flags(*labels, &stays);  // of one that it shared with before, it leaves only what others have, too
  }
  if (hit.empty() && !only.empty()) return;
  if (hit.empty()) {
    keep_flags_in(had, &left);
  } else {
    take_out_flags(stays, &shared);
    take_out_flags(shared, &left);
  }
  std::erase_if(object->leaves_also, [&](ObjectId id) { return holds(hit, id); });
  set_left(object, count_flags(left) > 0 ? make_flags(std::move(left)) : nullptr, true);
}

}  // namespace

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
  take_out_flags(*known_labels(document, object, gaussians, known), &kept);
  return count_flags(kept) > 0 ? make_flags(std::move(kept)) : nullptr;
}

void leave_to_locked(const Document& document, ObjectItem* object, std::size_t gaussians, LabelCache* known) {
  const Flags kept = kept_by_locked(document, *object, gaussians, known);
  if (!kept) return;
  std::vector<std::uint8_t> left = *kept;
  if (object->of_others) add_flags(*object->of_others, &left);
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
  for (const Flags& of_one : had) add_flags(*of_one, &all);
  set_left_earlier(&out, make_flags(std::move(all)));
  if (may_be_shared.empty()) return out;
  for (const std::vector<std::int32_t>& of_stroke : hits()) {
    const auto is_meant = [&](const Flags& of_one) { return is_made_on(of_one, of_stroke); };
    if (out.of_others && std::ranges::any_of(may_be_shared, is_meant))
      share_with(document, &out, of_stroke, gaussians, came, known);
  }
  return out;
}

}  // namespace splatcut
