// What else the first click can mean: which meanings are offered, and what keys 1 to 3 are for.
#include <fmt/format.h>

#include <algorithm>

#include "app/studio/clicks.h"
#include "segment/selection/click_selection.h"

namespace splatcut {

const ClickMeanings* Clicks::meanings(const ObjectItem& object) const {
  const CutRun* run = cuts_.run(object.id);
  if (!run || !run->meanings) return nullptr;
  const bool same_click = run->meanings->key == ws_.history.keys(object).first_click;
  return same_click ? run->meanings.get() : nullptr;
}

// Whether the screen shows them or not.
const ClickMeanings* Clicks::offered() const {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || object->locked || stroke_count(*object) != 1 || ws_.gaussians_of(object->id) == 0)
    return nullptr;
  const ClickMeanings* known = meanings(*object);
  return known && known->outlines.size() > 1 && known->key != declined_offer_ ? known : nullptr;
}

const ClickMeanings* Clicks::offer() const {
  const bool asks = tool_of(ws_.view.tool).clicks_object;
  return asks && ws_.view.display == DisplayMode::kWhole && !ws_.view.heat ? offered() : nullptr;
}

// Null: nothing that is or could be offered is declined or hidden by the tool.
const ObjectItem* Clicks::object_of_offers() const {
  const ObjectItem* object = ws_.document().active_object();
  const bool may = object && !object->locked && tool_of(ws_.view.tool).clicks_object &&
                   stroke_count(*object) == 1 && std::ranges::any_of(object->views, marks_object) &&
                   declined_offer_ != ws_.history.keys(*object).first_click;
  return may ? object : nullptr;
}

bool Clicks::offer_comes() const {
  const ObjectItem* object = object_of_offers();
  if (!object || ws_.view.display != DisplayMode::kWhole || ws_.view.heat || offered()) return false;
  const bool recalled = object->cut && !object->cut_kept && !cuts_.run(object->id) &&
                        !is_stale(*object, ws_.history.keys(*object).cut);  // of opened work
  return cuts_.comes(*object) || recalled;
}

std::string Clicks::why_no_meanings() const {
  const bool hidden = object_of_offers() && offered() && ws_.view.display != DisplayMode::kWhole;
  return hidden ? "What else the click can mean is shown in the whole scene (Shift+H)" : "";
}

// Before they are known, the keys of others than the likeliest are no tools either: else it would depend on
// the moment what a key does.
bool Clicks::chooses_by(int key) const {
  if (key < '1' || key >= '1' + kMostMeanings) return false;
  return offer() || (key > '1' && offer_comes());
}

bool Clicks::lacks_meaning(int key) const {
  const ObjectItem* object = object_of_offers();
  return key > '1' && key < '1' + kMostMeanings && object && object->cut && !object->cut_kept &&
         ws_.gaussians_of(object->id) > 0 && !offered() && !offer_comes() &&
         ws_.view.display == DisplayMode::kWhole && !ws_.view.heat;
}

std::string Clicks::why_no_meaning(Action pressed) const {
  const ObjectItem* object = ws_.document().active_object();
  const Stroke* last = object ? last_stroke(object->views) : nullptr;
  const Tool* tool = tool_of(pressed);
  return fmt::format(
      "This {} has no other meaning; the wheel right after it takes more or less{}",
      last && last->is_box() ? "box" : "click",
      tool && *tool != ws_.view.tool ? fmt::format(". The tool is {} now", name_of(pressed)) : "");
}

std::string Clicks::why_not_choose(int choice) const {
  const ClickMeanings* offered = offer();
  if (!offered) return why_no_meaning();
  if (choice < std::ssize(offered->outlines)) return {};
  return "Two meanings are offered: keys 1 and 2. After Esc, 3 is a tool again";
}

bool Clicks::decline_offer() {
  const bool shown = offer() != nullptr;
  const ObjectItem* object = ws_.document().active_object();
  if (object && stroke_count(*object) == 1)  // also one that is still computed
    declined_offer_ = ws_.history.keys(*object).first_click;
  return shown;
}

// A click that undo or its dot took away may be made again, and offers again.
void Clicks::forget_declined() {
  const auto is_declined = [&](const ObjectItem& object) {
    return ws_.history.keys(object).first_click == declined_offer_;
  };
  if (std::ranges::none_of(ws_.document().objects, is_declined)) declined_offer_.clear();
}

}  // namespace splatcut
