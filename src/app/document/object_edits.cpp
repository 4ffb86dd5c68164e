// Edits of the list of objects: new ones, names, merging, splitting, who has what.
#include <algorithm>
#include <cmath>

#include "app/document/edited_object.h"

namespace splatcut {

namespace {

std::string free_name(const Document& document, const std::string& base) {
  const auto taken = [&](const std::string& name) {
    return std::ranges::find(document.objects, name, &ObjectItem::name) != document.objects.end();
  };
  std::string name = base;
  for (int i = 2; taken(name); ++i) name = fmt::format("{} {}", base, i);
  return name;
}

// Adds an object that holds exactly `labels`, by manual marks and without strokes.
ObjectItem& add_by_hand(Document* document, const std::string& name,
                        const std::vector<std::uint8_t>& labels) {
  ObjectItem& object = add_object(document, free_name(*document, name));
  std::vector<std::uint8_t> hand(labels.size());
  std::ranges::transform(labels, hand.begin(), [](std::uint8_t l) { return l ? kHandObject : kFollowCut; });
  object.hand = make_flags(std::move(hand));
  return object;
}

}  // namespace

std::string edit(Document* document, const NewObject& command, const EditContext&) {
  std::string name;
  if (command.within != 0) name = free_name(*document, "Part of " + required(document, command.within).name);
  ObjectItem& object = add_object(document, name);
  object.within = command.within;
  return object.name + " added. Click what belongs to it.";
}

std::string edit(Document* document, const RemoveObject& command, const EditContext& context) {
  const std::string name = unlocked(document, command.object).name;
  for (ObjectItem& part : document->objects) {
    if (part.within != command.object) continue;
    // Its labels are limited to the whole only as long as that is there.
    const std::vector<std::uint8_t> shown = labels(*document, part, context);
    part.within = 0;
    set_labels(document, &part, shown);
  }
  std::erase_if(document->objects, [&](const ObjectItem& o) { return o.id == command.object; });
  if (document->active == command.object)
    document->active = document->objects.empty() ? 0 : document->objects.back().id;
  return name + " removed from the list; its Gaussians stay in the scene";
}

std::string edit(Document* document, const RenameObject& command, const EditContext&) {
  if (command.name.empty()) throw Error("", "The name is empty");
  required(document, command.object).name = command.name;
  return "Renamed to " + command.name;
}

std::string edit(Document* document, const RecolourObject& command, const EditContext&) {
  ObjectItem& object = required(document, command.object);
  object.colour = command.colour;
  return "Colour of " + object.name;
}

std::string edit(Document* document, const TintObject& command, const EditContext&) {
  ObjectItem& object = required(document, command.object);
  object.tinted = command.tinted;
  return fmt::format("The tint of {} is {}", object.name, command.tinted ? "shown" : "hidden");
}

std::string edit(Document* document, const LockObject& command, const EditContext& context) {
  ObjectItem& object = required(document, command.object);
  object.locked = command.locked;
  if (command.locked) leave_to_locked_one(document, object, context.cloud.size());
  const bool comes = command.locked && is_stale(*document, object);
  for (ObjectItem& other : document->objects) {
    if (!comes || other.id == object.id) continue;
    const bool known = std::ranges::find(other.leaves_also, object.id) != other.leaves_also.end();
    if (!known) other.leaves_also.push_back(object.id);
  }
  return object.name + (command.locked ? " locked" : " unlocked");
}

std::string edit(Document* document, const ActivateObject& command, const EditContext&) {
  document->active = required(document, command.object).id;
  return required(document, command.object).name + " is active";
}

std::string edit(Document* document, const MergeObjects& command, const EditContext& context) {
  if (command.into == command.from) throw Error("", "An object cannot be merged with itself");
  const std::vector<std::uint8_t> from = labels(*document, unlocked(document, command.from), context);
  ObjectItem& into = unlocked(document, command.into);
  const Selection both = combined(labels(*document, into, context), from, SetOperation::kAdd);
  into.within = 0;
  set_labels(document, &into, both);
  const std::string name = into.name;
  edit(document, RemoveObject{command.from}, context);
  document->active = command.into;
  return counted(*document, *document->find(command.into), context);
}

std::string edit(Document* document, const SplitObject& command, const EditContext& context) {
  const ObjectItem object = unlocked(document, command.object);
  const Selection whole = labels(*document, object, context);
  const Parts parts = connected_parts(context.cloud, required_graph(context), whole);
  // Tiny pieces are no objects: they stay with the largest part.
  constexpr double kSmallestShare = 0.01;
  const auto least =
      static_cast<std::size_t>(std::ceil(kSmallestShare * static_cast<double>(count_flags(whole))));
  std::int32_t pieces = 0;
  while (pieces < static_cast<std::int32_t>(parts.size.size()) &&
         parts.size[static_cast<std::size_t>(pieces)] >= std::max<std::size_t>(1, least))
    ++pieces;
  if (pieces < 2) throw Error(object.name, "is one connected piece: there is nothing to split");
  Selection rest = whole;
  for (std::int32_t p = 1; p < pieces; ++p) {
    Selection piece(whole.size());
    for (std::size_t g = 0; g < whole.size(); ++g)
      if (parts.part[g] == p) {
        piece[g] = 1;
        rest[g] = 0;
      }
    add_by_hand(document, fmt::format("{} part {}", object.name, p + 1), piece);
  }
  set_labels(document, document->find(command.object), rest);
  document->active = command.object;
  return fmt::format("{} split into {} objects", object.name, pieces);
}

std::string edit(Document* document, const DuplicateObject& command, const EditContext&) {
  ObjectItem copy = required(document, command.object);
  const std::string name = free_name(*document, copy.name + " copy");
  ObjectItem& made = add_object(document, name);
  copy.id = made.id;
  copy.name = made.name;
  copy.colour = made.colour;
  copy.locked = false;
  made = std::move(copy);
  return made.name + " added";
}

std::string edit(Document* document, const SeparateObject& command, const EditContext& context) {
  const ObjectItem& object = required(document, command.object);
  const std::string name = object.name;
  const Selection own = labels(*document, object, context);
  std::size_t taken = 0;
  for (ObjectItem& other : document->objects) {
    if (other.id == command.object || other.locked || is_part_of(*document, object, other.id) ||
        is_part_of(*document, other, command.object))
      continue;
    const Selection before = labels(*document, other, context);
    const Selection after = combined(before, own, SetOperation::kRemove);
    taken += count_flags(before) - count_flags(after);
    set_labels(document, &other, after, own);
  }
  return fmt::format("{} Gaussians now belong to {} alone", grouped(taken), name);
}

std::string edit(Document* document, const LeaveToOthers& command, const EditContext& context) {
  ObjectItem& object = unlocked(document, command.object);
  if (command.leaves)
    set_of_others(&object, had_by_others(*document, object, context.cloud.size(), 0, context.labels));
  else
    share_again(*document, &object, context.cloud.size(), context.labels);
  if (command.leaves && !object.of_others) return "The other objects have nothing: " + object.name + " stays";
  return fmt::format("{}: {}", command.leaves ? "Now without the other objects" : "Now with what others have",
                     counted(*document, object, context));
}

}  // namespace splatcut
