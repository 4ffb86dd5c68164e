#include "app/picture/cut_sentences.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/document/words.h"
#include "segment/finish/shown_part.h"
#include "segment/session/doubts.h"

namespace splatcut {

std::string what_changed(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after,
                         double seconds) {
  std::size_t was = 0, is = 0, added = 0;
  for (std::size_t g = 0; g < after.size(); ++g) {
    was += before[g];
    is += after[g];
    added += after[g] && !before[g];
  }
  const std::size_t removed = was + added - is;
  if (was == 0) return fmt::format("{} cut out in {:.1f} s", gaussians_text(is), seconds);
  if (added + removed == 0) return gaussians_text(is) + ", as before";
  return fmt::format("{}, {} added and {} removed in {:.1f} s", gaussians_text(is), grouped(added),
                     grouped(removed), seconds);
}

bool is_of_stroke(const History& history) {
  const std::string& title = history.entries()[history.cursor()].title;
  return !history.left() && history.can_undo() &&
         (title.starts_with("Click") || title.starts_with("Scribble"));
}

bool changed_little(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after) {
  constexpr double kLittle = 0.02;  // of the object
  std::size_t is = 0, changed = 0;
  for (std::size_t g = 0; g < after.size(); ++g) {
    is += after[g];
    changed += before[g] != after[g];
  }
  return static_cast<double>(changed) < kLittle * static_cast<double>(is);
}

std::size_t waiting_strokes(const History& history, ObjectId object) {
  std::size_t waiting = 0;
  for (std::size_t i = history.cursor() + 1; i-- > 0; ++waiting) {
    const Document& then = history.entries()[i].document;
    const ObjectItem* item = then.find(object);
    if (!item || item->views.empty() || !is_stale(then, *item)) break;
  }
  return waiting;
}

std::size_t small_removals(const History& history, ObjectId object, std::size_t gaussians) {
  constexpr std::size_t kMostAsked = 3;
  std::size_t found = 0;
  for (std::size_t i = history.cursor(); i > 0 && found < kMostAsked; --i, ++found) {
    const Document &then = history.entries()[i].document, &last = history.entries()[i - 1].document;
    const ObjectItem *is = then.find(object), *was = last.find(object);
    if (!is || !was || stroke_count(*is) != stroke_count(*was) + 1 || is_stale(then, *is) ||
        is_stale(last, *was))
      break;
    const Stroke* stroke = last_stroke(is->views);
    if (!stroke->is_click() || stroke->label != SeedLabel::kRest ||
        !changed_little(labels_of(last, *was, gaussians), labels_of(then, *is, gaussians)))
      break;
  }
  return found;
}

std::string why_so_already(const CutRequest& request, const CutResult& result, bool little_changed) {
  const bool adds = !last_takes_away(request.strokes);
  return std::string(!adds ? "that place does not belong to it as it is. To remove more, right-click a piece "
                             "of it"
                     : little_changed
                         ? "little was missing there. To take more, click what is missing"
                         : "that place belonged to it already. To take more, click what is missing") +
         (result.size + 1 < result.sizes ? adds ? ", or press + for a larger part" : ", or press +" : "");
}

std::string why_one_size(int steps, bool takes_away) {
  if (takes_away)
    return "The click takes this away, no more and no less: right-click what is left, click what is missing";
  return steps > 0 ? "No larger part holds this place: click beside it, or drag a box (4) around the thing"
                   : "No smaller part was found in it: right-click what does not belong to it";
}

std::string why_no_larger(std::size_t taken, std::size_t all) {
  constexpr double kNearlyAll = 0.95;
  const bool whole = static_cast<double>(taken) > kNearlyAll * static_cast<double>(all);
  return std::string("This is the largest size") +
         (whole ? ": nearly the whole scene is taken. Page Down takes less"
                : ": no larger part holds this place. Click beside it, or drag a box (4) around the thing");
}

std::string leap_of_size(std::size_t was, std::size_t is) {
  constexpr std::size_t kLeap = 4;  // times as many Gaussians, or that part of them
  if (is <= kLeap * was && was <= kLeap * is) return {};
  return "; no size between was found: a box (4) around the thing, or clicks, find it";
}

std::string wheel_hint(const CutRequest& request, const CutResult& result,
                       const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after) {
  const bool first = first_stroke(request.strokes) == last_stroke(request.strokes);
  if (result.sizes < 2 || (first && (!unsure(result) || result.meanings.size() > 1))) return {};
  const bool more = result.size + 1 < result.sizes;
  const bool less = result.size > 0 && (first || !changed_little(before, after));
  return std::string(more || less ? ". The wheel takes " : "") + (more ? "more" : "") +
         (more && less ? " or " : "") + (less ? "less" : "") +
         ((more || less) && last_takes_away(request.strokes) ? " away" : "");
}

bool add_doubt_of_sides(CutRun* run) {
  if (std::ranges::all_of(run->views, [](const ViewCard& card) { return card.doubt.empty(); })) return false;
  run->doubts.emplace_back(kDoubtOfSides);
  return true;
}

std::string tip_of_card(const ViewCard& card, std::size_t index, bool steady) {
  std::string tip = index == 0 ? "First view: where the object was begun" : fmt::format("View {}", index);
  if (card.only_to_look)
    tip = "Around the object";
  else if (!card.used)
    tip += "\nDoes not count: " + (card.reason.empty() ? std::string("left out") : card.reason);
  else if (index > 0 && !steady)
    tip += fmt::format("\nAgrees with the cutout: {:.0f} %", 100 * card.confidence);
  if (!card.doubt.empty()) tip += "\nIn doubt: " + card.doubt;
  return tip + card.legend + "\nClick to look from there; correct it with strokes.";
}

std::string shared_with(const Document& document, ObjectId id, const LabelsOfObject& labels_of_object) {
  const ObjectItem* object = document.find(id);
  const Flags own = labels_of_object(*object);
  const std::vector<std::uint32_t> rows = labelled_rows(*own);
  std::vector<std::uint32_t> left;  // what it would have, and leaves to others
  for (std::uint32_t g = 0; object->cut && object->of_others && g < own->size(); ++g)
    if ((*object->cut)[g] & (*object->of_others)[g] & !(*own)[g]) left.push_back(g);
  for (const ObjectItem& other : document.objects) {
    if (other.id == id || other.id == object->within || other.within == id) continue;
    const Flags labels = labels_of_object(other);
    const auto has = [&](std::uint32_t g) { return (*labels)[g] != 0; };
    const auto kept = static_cast<std::size_t>(std::ranges::count_if(left, has));
    constexpr double kWorthSaying = 0.01;  // of the object
    if (kept > 0 && static_cast<double>(kept) >= kWorthSaying * static_cast<double>(rows.size()))
      return fmt::format(". {} that {} had before stay its own; the menu of {} has a way to take them, too",
                         gaussians_text(kept), other.name, object->name);
    const auto both = static_cast<std::size_t>(std::ranges::count_if(rows, has));
    if (both > 0 && 2 * both > count_flags(*labels))
      return fmt::format(". {} of {}'s are in it, too", grouped(both), other.name);
  }
  return {};
}

}  // namespace splatcut
