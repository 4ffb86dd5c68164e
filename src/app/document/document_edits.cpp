#include "app/document/document_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/document/edited_object.h"
#include "app/document/words.h"
#include "core/error.h"
#include "scene/cloud/gaussian_cloud.h"
#include "segment/selection/click_selection.h"

namespace splatcut {

namespace {

// Returns the object that a stroke goes to. Its first stroke settles for it which way is up: views around it
// depend on that, and turning the scene later is no reason to compute it again.
ObjectItem& stroked(Document* document) {
  ObjectItem& object = target(document);
  if (object.views.empty()) {
    object.up_world = document->up_world;
    object.among = nullptr;
  }
  return object;
}

// Returns the word for what began the object, whose meanings are offered.
const char* first_stroke_word(const ObjectItem& object) {
  for (const StrokedView& view : object.views)
    if (!view.strokes.empty()) return view.strokes.front().is_box() ? "box" : "click";
  return "click";
}

// A new object shows on what it was begun on, and takes nothing that others have, unless it is begun on that:
// then it is a part of it, or they share. A later stroke there takes it after all. hits: what a stroke on the
// object was made on.
void settle_with_others(Document* document, ObjectItem* object, std::span<const std::int32_t> hits,
                        bool first, const EditContext& context) {
  const std::size_t n = context.cloud.size();
  if (const ObjectItem* kept = locked_under(*document, *object, hits))
    throw Error(kept->name, "is locked, and no other object takes what it has",
                "Unlock it in the objects panel");
  if (first) {
    const ObjectItem* undone = context.undone ? context.undone->find(object->id) : nullptr;
    if (undone) object->colour = undone->colour;  // it is begun again
    if (!hits.empty())                            // of a box the one in its middle
      stand_out(document, object->id,
                base_colour(context.cloud, static_cast<std::size_t>(hits[hits.size() / 2])));
    leave_to_others(*document, object, n, context.labels);
  }
  if (means_what_is_left(*document, *object, hits))
    share_what_is_hit(*document, object, hits, n, context.labels);
  leave_to_locked(*document, object, n, context.labels);
  if (reaches_beyond(*object, hits)) object->among = nullptr;
}

// Of what a view shows, that which the object is not cut among.
Flags beyond(const ObjectItem& object, const Flags& seen) {
  std::vector<std::uint8_t> out(object.among->size());
  for (std::size_t g = 0; g < out.size(); ++g) out[g] = !(*object.among)[g] && (!seen || (*seen)[g]);
  return make_flags(std::move(out));
}

// Where the next stroke goes: strokes stay in order, so another view in between starts a new entry.
StrokedView& view_for(ObjectItem* object, const Camera& camera, const Flags& seen) {
  std::vector<StrokedView>& views = object->views;
  const Camera known = known_camera(*object, camera);
  if (views.empty() || !same_camera(views.back().camera, known) || !same_set(views.back().seen, seen))
    views.push_back({known, {}, seen});
  return views.back();
}

// With the views that did not count for it.
void forget_cut(ObjectItem* object) {
  object->left_out.clear();
  object->cut = nullptr;
  object->cut_key.clear();
}

}  // namespace

bool is_begun_by_next(const Document& document, const ObjectItem& object, const EditContext& context) {
  if (std::ranges::any_of(object.views, marks_object)) return false;
  return (!object.cut && !object.hand) || count_of(document, object, context) == 0;
}

std::span<const Backdrop> backdrops() {
  static constexpr Backdrop kBackdrops[] = {{"Dark", {0.11f, 0.115f, 0.125f}},
                                            {"Grey", {0.5f, 0.5f, 0.5f}},
                                            {"White", {1, 1, 1}},
                                            {"Checker", {0.5f, 0.5f, 0.5f}, true},
                                            {"Magenta", {1, 0, 1}}};
  return kBackdrops;
}

bool shows(const Backdrop& backdrop, const Document& document, const ViewState& view) {
  constexpr float kSame = 1e-3f;
  if (backdrop.checker || view.checker) return backdrop.checker && view.checker;
  const glm::vec3 d = glm::abs(backdrop.colour - document.background);
  return std::max({d.r, d.g, d.b}) < kSame;
}

bool asks_what_is_hit(const Document& document, SeedLabel label, const EditContext& context) {
  const ObjectItem* object = document.active_object();
  if (label == SeedLabel::kRest) return object && object->among;
  return !object || object->among || object->of_others ||
         std::ranges::any_of(document.objects, &ObjectItem::locked) ||
         is_begun_by_next(document, *object, context);
}

std::string edit(Document* document, const AddStroke& command, const EditContext& context) {
  if (command.stroke.points_px.empty()) throw Error("", "The stroke has no points");
  ObjectItem& object = stroked(document);
  const bool dot = command.stroke.is_click();
  const bool rest = command.stroke.label == SeedLabel::kRest;
  if (!rest)
    settle_with_others(document, &object, command.hits, is_begun_by_next(*document, object, context),
                       context);
  const bool elsewhere = rest && reaches_beyond(object, command.hits);
  view_for(&object, command.camera, elsewhere ? beyond(object, command.seen) : command.seen)
      .strokes.push_back(command.stroke);
  return fmt::format("{} {} {}", dot ? "Click:" : "Scribble:", rest ? "not part of" : "part of", object.name);
}

std::string added_by_box(const History& history, ObjectId id, const EditContext& context) {
  if (history.entries()[history.cursor()].title != AddBox{}.title() || !history.can_undo()) return {};
  const Document& before = history.entries()[history.cursor() - 1].document;
  const ObjectItem* object = before.find(id);
  if (!object || id != before.active || is_begun_by_next(before, *object, context)) return {};
  return fmt::format(
      ". The box added to {}, which was begun before. For an object of its own: New object (Ctrl+N), then "
      "the "
      "box",
      object->name);
}

Flags left_by_stroke(const Document& document, const EditContext& context) {
  const ObjectItem* object = document.active_object();
  if (object && !is_begun_by_next(document, *object, context)) return object->of_others;
  return had_by_others(document, object ? *object : ObjectItem{}, context.cloud.size(), 0, context.labels);
}

Flags changed_by(const Document& document, const AddStroke& stroke, std::vector<std::uint8_t> before,
                 std::vector<std::uint8_t> after, const Flags& left, const EditContext& context) {
  const auto with_cut = [&](Document now, std::vector<std::uint8_t> cut) {
    ObjectItem* object = now.find(now.active);
    if (!object) return cut;  // nothing is begun yet
    object->cut = make_flags(std::move(cut));
    return labels(now, *object, context);
  };
  Document stroked_document = document;
  ObjectItem& object = target(&stroked_document);
  if (stroke.stroke.label == SeedLabel::kObject) {
    if (object.of_others != left) set_of_others(&object, left);
    const std::size_t n = context.cloud.size();
    if (locked_under(document, object, stroke.hits)) after = before;
    if (means_what_is_left(document, object, stroke.hits))
      share_what_is_hit(document, &object, stroke.hits, n);
  }
  std::vector<std::uint8_t> change = with_cut(document, std::move(before));
  const std::vector<std::uint8_t> then = with_cut(std::move(stroked_document), std::move(after));
  for (std::size_t g = 0; g < change.size(); ++g) change[g] = change[g] != then[g];
  return make_flags(std::move(change));
}

Stroke stroke_of(const AddBox& command, SeedLabel label) {
  Stroke box = box_around(command.a_px, command.b_px, label);
  const int width = command.camera.width_px, height = command.camera.height_px;
  if (box_is_too_small(box, width, height)) {
    constexpr float kSlipPx = 30;  // a longer drag was meant
    const glm::vec2 size = box_in_picture(box, width, height).size_px();
    throw Error("",
                size.x > kSlipPx   ? "The box is too flat"
                : size.y > kSlipPx ? "The box is too narrow"
                                   : "The box is too small",
                "Drag from one corner to the other");
  }
  return box;
}

std::string edit(Document* document, const AddBox& command, const EditContext& context) {
  const Stroke box = stroke_of(command, SeedLabel::kObject);
  ObjectItem& object = stroked(document);
  const bool first = is_begun_by_next(*document, object, context);
  settle_with_others(document, &object, command.hits, first, context);
  view_for(&object, command.camera, command.seen).strokes.push_back(box);
  return (first ? "Box around " : "Box: adds to ") + object.name;
}

std::string edit(Document* document, const RemoveStroke& command, const EditContext&) {
  if (!document->active_object()) throw Error("", "No object is chosen");
  ObjectItem& object = unlocked(document, document->active);
  const auto known = [&] {
    if (command.view >= object.views.size()) return false;
    const Strokes& strokes = object.views[command.view].strokes;
    return command.stroke < strokes.size() && strokes[command.stroke].points_px.front() == command.at_px;
  };
  if (!known()) throw Error("", "That click is not there any more");
  const auto view = object.views.begin() + static_cast<std::ptrdiff_t>(command.view);
  const auto gone = view->strokes.begin() + static_cast<std::ptrdiff_t>(command.stroke);
  const bool first = &*gone == first_stroke(object.views);
  view->strokes.erase(gone);
  if (view->strokes.empty()) object.views.erase(view);
  Stroke* next = first_stroke(&object.views);
  if (first) object.choice = 0;
  if (first && next) next->size_step = 0;  // as the first it has other sizes
  if (next) return fmt::format("A click taken away: {} follows those that are left", object.name);
  const bool any_rest = !object.views.empty();
  object.views.clear();
  forget_cut(&object);
  return fmt::format("A click taken away{}: nothing marks {} any more",
                     any_rest ? ", and those on the rest with it" : "", object.name);
}

namespace {

// The object leaves these to others, as in `before` some of them. What hands took since stays.
void leave(Flags others, const ObjectItem& before, ObjectItem* object) {
  object->of_others = std::move(others);
  if (!object->hand || !before.hand) return;
  std::vector<std::uint8_t> hand = *object->hand;
  for (std::size_t g = 0; g < hand.size(); ++g)
    if (hand[g] == kHandObject && (*before.hand)[g] == kHandLeft) hand[g] = kHandLeft;
  object->hand = make_flags(std::move(hand));
}

// What the object left to others in `before`, and with a stroke in `made` no more: it leaves that again,
// unless it leaves some of that meanwhile, and not because it is locked.
void leave_again(const Document& document, const ObjectItem& before, const ObjectItem& made,
                 ObjectItem* object, std::size_t gaussians, LabelCache* known) {
  const auto is_later = [&](ObjectId id) {
    return std::ranges::find(made.leaves_also, id) == made.leaves_also.end();
  };
  if (!before.of_others || std::ranges::any_of(object->leaves_also, is_later)) return;
  const Flags kept = kept_by_locked(document, *object, gaussians, known);
  const auto has = [](const Flags& flags, std::size_t g) { return flags && (*flags)[g]; };
  std::vector<std::uint8_t> left = *before.of_others;
  bool ended = false;
  for (std::size_t g = 0; g < gaussians; ++g) {
    const bool ended_here = left[g] && !has(made.of_others, g), now = has(object->of_others, g);
    if (ended_here && now && !has(kept, g)) return;
    ended |= ended_here;
    left[g] |= now;
  }
  if (!ended) return;
  leave(make_flags(std::move(left)), before, object);
  object->leaves_also = before.leaves_also;
}

}  // namespace

void take_back_sharing(const History& history, const RemoveStroke& gone, Document* document,
                       std::size_t gaussians, LabelCache* known) {
  ObjectItem* object = document->find(document->active);
  const ObjectItem* now = history.now().find(object->id);
  const Camera& camera = now->views.at(gone.view).camera;
  const auto holds = [&](const ObjectItem& item) {
    return std::ranges::any_of(item.views, [&](const StrokedView& view) {
      return same_camera(view.camera, camera) && std::ranges::any_of(view.strokes, [&](const Stroke& s) {
               return s.points_px.front() == gone.at_px;
             });
    });
  };
  const ObjectItem* made = now;
  for (std::size_t e = history.cursor(); e-- > 0;) {
    const ObjectItem* before = history.entries()[e].document.find(object->id);
    if (!before) return;
    if (holds(*before)) {
      made = before;
      continue;
    }
    leave_again(*document, *before, *made, object, gaussians, known);
    if (before->among && !made->among && !object->among) object->among = before->among;
    return;
  }
}

std::string edit(Document* document, const ClearStrokes&, const EditContext&) {
  if (!document->active_object()) throw Error("", "No object is chosen");
  ObjectItem& object = unlocked(document, document->active);
  if (object.views.empty()) throw Error(object.name, "has no strokes");
  object.views.clear();
  object.choice = 0;
  forget_cut(&object);
  return "Strokes of " + object.name + " cleared";
}

std::string StepScale::title(const Document& document) const {
  const ObjectItem* object = document.active_object();
  if (object && last_takes_away(object->views)) return steps > 0 ? "Takes more away" : "Takes less away";
  return steps > 0 ? "Larger part" : "Smaller part";
}

std::string edit(Document* document, const StepScale& command, const EditContext&) {
  if (!document->active_object()) throw Error("", "No object is chosen", "Click an object first");
  ObjectItem& object = unlocked(document, document->active);
  if (object.views.empty()) throw Error("", object.name + " has no clicks", "Click on it first");
  Stroke* last = last_stroke(&object.views);
  if (!last) throw Error("", object.name + " has no clicks on it", "Click on it first");
  last->size_step = std::clamp(last->size_step + command.steps, -kMostSizeSteps, kMostSizeSteps);
  return fmt::format("A {} part {}is being computed", command.steps > 0 ? "larger" : "smaller",
                     last_takes_away(object.views) ? "to take away " : "");
}

std::string ChooseMeaning::title(const Document& document) const {
  const ObjectItem* object = document.active_object();
  return fmt::format("Meaning {} of the {}", choice + 1, object ? first_stroke_word(*object) : "click");
}

std::string edit(Document* document, const ChooseMeaning& command, const EditContext&) {
  if (!document->active_object()) throw Error("", "No object is chosen", "Click an object first");
  ObjectItem& object = unlocked(document, document->active);
  if (object.views.empty()) throw Error(object.name, "has no clicks", "Click on it first");
  object.choice = std::clamp(command.choice, 0, kMostMeanings - 1);
  if (Stroke* first = first_stroke(&object.views)) first->size_step = 0;
  return fmt::format("{}: meaning {} of the {}", object.name, object.choice + 1, first_stroke_word(object));
}

std::string edit(Document* document, const LeaveOutView& command, const EditContext&) {
  ObjectItem& object = unlocked(document, command.object);
  std::erase_if(object.left_out, [&](const Camera& c) { return same_view(c, command.view); });
  if (command.left_out) object.left_out.push_back(command.view);
  return fmt::format("A view of {} {}", object.name, command.left_out ? "left out" : "counts again");
}

std::string edit(Document* document, const SetSmoothness& command, const EditContext&) {
  ObjectItem& object = unlocked(document, command.object);
  constexpr float kMost = 500;
  object.smoothness = command.smoothness;
  if (!object.smoothness) return "Smoothness: the method's own";
  object.smoothness = std::clamp(*object.smoothness, 0.0f, kMost);
  return fmt::format("Smoothness {:.2f}", *object.smoothness);
}

std::string edit(Document* document, const SetPreset& command, const EditContext&) {
  preset(command.preset);  // throws for an unknown one
  document->preset = command.preset;
  return "Method: " + command.preset;
}

std::string edit(Document* document, const SetBackground& command, const EditContext&) {
  document->background = glm::clamp(command.colour, 0.0f, 1.0f);
  return "Background colour";
}

std::string edit(Document* document, const SetUp& command, const EditContext&) {
  if (!(glm::length(command.up_world) > 1e-6f))
    throw Error("", "The three points lie on one line", "Pick three corners of the ground");
  document->up_world = glm::normalize(command.up_world);
  return "Up direction set";
}

}  // namespace splatcut
