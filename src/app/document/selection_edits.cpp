// What hands do to the chosen object: regions, shapes, the selection's own edits, and deleting it.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/document/document_edits.h"
#include "app/document/edited_object.h"
#include "app/document/words.h"
#include "core/error.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

namespace {

Selection inverted(const Selection& selection) {
  Selection out(selection.size());
  std::ranges::transform(selection, out.begin(), [](std::uint8_t s) { return s ? 0 : 1; });
  return out;
}

// Takes out of what an edit makes of an object what is deleted and what locked ones keep, and says the
// latter; empty: they keep nothing.
std::string leave_locked(const Document& document, const ObjectItem& object, Selection* after) {
  if (document.deleted) *after = combined(*after, *document.deleted, SetOperation::kRemove);
  const Flags kept = kept_by_locked(document, object, after->size());
  std::size_t left = 0;
  for (std::size_t g = 0; kept && g < after->size(); ++g)
    if ((*kept)[g] && std::exchange((*after)[g], std::uint8_t{0})) ++left;
  return left > 0 ? fmt::format(". What is locked keeps {}", gaussians_text(left)) : "";
}

}  // namespace

std::string edit_selection(Document* document, const Selection& region, SetOperation operation,
                           const EditContext& context) {
  ObjectItem& object = target(document);
  const std::vector<std::uint8_t> before = labels(*document, object, context);
  Selection after = combined(before, region, operation);
  const std::string kept = leave_locked(*document, object, &after);
  Selection taken_out = region;
  if (operation == SetOperation::kAdd) taken_out.clear();
  if (operation == SetOperation::kIntersect) taken_out = inverted(region);
  set_labels(document, &object, after, taken_out);
  const std::vector<std::uint8_t> now = labels(*document, object, context);  // a part stays in its whole
  std::size_t changed = 0;
  for (std::size_t g = 0; g < now.size(); ++g) changed += (before[g] != 0) != (now[g] != 0);
  const char* what = operation == SetOperation::kAdd      ? "added"
                     : operation == SetOperation::kRemove ? "removed"
                                                          : "changed";
  return fmt::format("{} {}. {}{}", gaussians_text(changed), what, counted(*document, object, context), kept);
}

std::string edit_by_shape(Document* document, const Selection& region, SetOperation operation,
                          const EditContext& context) {
  ObjectItem& object = target(document);
  if (operation != SetOperation::kAdd) return edit_selection(document, region, operation, context);
  const std::size_t n = region.size();
  const bool first = is_begun_by_next(*document, object, context);
  const std::vector<std::uint8_t> before = labels(*document, object, context);
  const Flags locked = kept_by_locked(*document, object, n);
  std::vector<std::int32_t> added;
  for (std::size_t g = 0; g < n; ++g)
    if (region[g] && !(locked && (*locked)[g]) && !before[g] &&
        !(document->deleted && (*document->deleted)[g]))
      added.push_back(static_cast<std::int32_t>(g));
  if (first) leave_to_others(*document, &object, n);
  if (means_what_is_left(*document, object, added)) {
    if (first) share_what_is_hit(*document, &object, added, n);
    return edit_selection(document, region, operation, context);
  }
  Selection left(n, 0), taken = region;
  const Flags had = had_by_others(*document, object, n);  // now, not when the object was begun
  for (const std::int32_t hit : added)
    if (const auto g = static_cast<std::size_t>(hit);
        had && (*had)[g] && object.of_others && (*object.of_others)[g]) {
      left[g] = 1;
      taken[g] = 0;
    }
  const std::string said = edit_selection(document, taken, operation, context);
  const std::size_t kept = count_flags(left);
  if (kept == 0) return said;
  std::vector<std::uint8_t> hand = *object.hand;
  for (std::size_t g = 0; g < n; ++g)
    if (left[g]) hand[g] = kHandLeft;
  object.hand = make_flags(std::move(hand));
  return fmt::format("{}. Others keep {} that they already had; the menu of {} has a way to take them, too",
                     said, gaussians_text(kept), object.name);
}

std::string EditSelection::title() const {
  switch (edit) {
    case SelectionEdit::kAll:
      return "Select all";
    case SelectionEdit::kNone:
      return "Select none";
    case SelectionEdit::kInvert:
      return "Invert";
    case SelectionEdit::kGrow:
      return "Grow";
    case SelectionEdit::kShrink:
      return "Shrink";
    case SelectionEdit::kLargestPart:
      return "Largest part";
    case SelectionEdit::kRemoveFloaters:
      return "Remove floaters";
  }
  return "";
}

std::string edit(Document* document, const EditSelection& command, const EditContext& context) {
  const std::size_t n = context.cloud.size();
  ObjectItem& object = target(document);
  const Selection before = labels(*document, object, context);
  Selection after(n, 0);
  switch (command.edit) {
    case SelectionEdit::kAll:
      after.assign(n, 1);
      break;
    case SelectionEdit::kNone:
      break;
    case SelectionEdit::kInvert:
      after = inverted(before);
      break;
    case SelectionEdit::kGrow:
      after = grown(required_graph(context), before);
      break;
    case SelectionEdit::kShrink:
      after = shrunk(required_graph(context), before);
      break;
    case SelectionEdit::kLargestPart:
      after = largest_part(context.cloud, required_graph(context), before);
      break;
    case SelectionEdit::kRemoveFloaters:
      after =
          combined(before, floaters(context.cloud, required_graph(context), before), SetOperation::kRemove);
      break;
  }
  const std::string kept = leave_locked(*document, object, &after);
  const bool none = command.edit == SelectionEdit::kNone;
  set_labels(document, &object, after, none ? Selection(n, 1) : Selection());
  if (command.edit == SelectionEdit::kAll)
    return fmt::format("{}{} are selected{}. Ctrl+Z takes it back", kept.empty() ? "All " : "",
                       gaussians_text(count_flags(labels(*document, object, context))), kept);
  const std::string now = counted(*document, object, context) + kept;
  if (command.edit != SelectionEdit::kRemoveFloaters) return now;
  const std::size_t gone = count_flags(before) - count_flags(labels(*document, object, context));
  return gaussians_text(gone) + " that floated apart removed. " + now;
}

std::string edit(Document* document, const DeleteSelected&, const EditContext& context) {
  if (!document->active_object()) throw Error("", "No object is chosen");
  const ObjectItem& object = unlocked(document, document->active);
  Selection selected = labels(*document, object, context);
  const std::size_t all = count_flags(selected);
  for (const ObjectItem& other : document->objects)
    if (other.locked) selected = combined(selected, labels(*document, other, context), SetOperation::kRemove);
  const std::size_t count = count_flags(selected);
  if (all > 0 && count == 0) throw Error(object.name, "shares all it has with what is locked");
  if (count == 0) throw Error(object.name, "holds no Gaussians: there is nothing to delete");
  Selection deleted(context.cloud.size(), 0);
  if (document->deleted) deleted = *document->deleted;
  document->deleted = make_flags(combined(deleted, selected, SetOperation::kAdd));
  return fmt::format("{} Gaussians of {} deleted from the scene (the file stays as it is){}", grouped(count),
                     object.name, all > count ? ". What is locked keeps " + gaussians_text(all - count) : "");
}

std::string edit(Document* document, const RestoreDeleted&, const EditContext&) {
  if (!document->deleted) throw Error("", "Nothing is deleted");
  document->deleted = nullptr;
  return "Deleted Gaussians restored";
}

}  // namespace splatcut
