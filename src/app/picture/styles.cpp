#include "app/picture/styles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/document/export_plan.h"
#include "app/document/selection.h"
#include "scene/cloud/joined_clouds.h"
#include "segment/finish/shown_part.h"

namespace splatcut {

namespace {

constexpr float kCheckerPoints = 12;

// hidden: what the scene is shown without; null: nothing.
Flags shown_in(DisplayMode mode, const Document& document, const Flags& active, const Flags& hidden) {
  if (mode == DisplayMode::kWhole && !document.deleted && !hidden) return nullptr;
  std::vector<std::uint8_t> set(active->size(), 1);
  for (std::size_t g = 0; g < set.size(); ++g) {
    if (mode == DisplayMode::kIsolate) set[g] = (*active)[g];
    if (mode == DisplayMode::kHide) set[g] = !(*active)[g];
    if (mode != DisplayMode::kIsolate && hidden && (*hidden)[g]) set[g] = 0;
    if (document.deleted && (*document.deleted)[g]) set[g] = 0;
  }
  return make_flags(std::move(set));
}

// Those that left the object are not shown.
Flags shown_of(const CleanObject& object, std::size_t gaussians) {
  std::vector<std::uint8_t> set(gaussians, 0);
  for (const std::uint32_t g : object.gaussian) set[g] = 1;
  return make_flags(std::move(set));
}

// With marks by hand and all else that labels come from.
Flags with_cut(const Document& document, ObjectItem object, const Flags& cut) {
  object.cut = cut;
  return make_flags(labels_of(document, object, cut->size()));
}

bool mostly_same(const Flags& was, const Flags& now) {
  if (!was || was->size() != now->size()) return false;
  std::size_t both = 0;
  for (std::size_t g = 0; g < now->size(); ++g) both += (*was)[g] && (*now)[g];
  return 2 * both >= std::max(count_flags(*was), count_flags(*now));
}

// What was cleaned before the labels changed, while it is cleaned anew: of what is still labelled the edges
// stay clean, and what is new comes as it is. Null where that is not mostly the same object.
std::shared_ptr<const CleanObject> carried_over(const std::shared_ptr<const CleanObject>& clean,
                                                const Flags& was, const Flags& now,
                                                const GaussianCloud& scene) {
  if (!clean || !mostly_same(was, now)) return nullptr;
  if (was == now || *was == *now) return clean;
  std::vector<std::uint32_t> stays, added, row, order;
  for (std::uint32_t g = 0; g < now->size(); ++g)
    if ((*now)[g] && !(*was)[g]) added.push_back(g);
  for (std::uint32_t i = 0; i < clean->gaussian.size(); ++i)
    if ((*now)[clean->gaussian[i]]) {
      stays.push_back(i);
      row.push_back(clean->gaussian[i]);
    }
  row.insert(row.end(), added.begin(), added.end());
  order.resize(row.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return row[i]; });
  CleanObject out;
  out.cloud = permuted(joined({permuted(clean->cloud, stays), permuted(scene, added)}), order);
  for (const std::uint32_t i : order) out.gaussian.push_back(row[i]);
  return std::make_shared<const CleanObject>(std::move(out));
}

bool changes_rest(const SceneWithout& without) {
  const auto some = [](const RestChanges& c) { return !c.ghosts.empty() || !c.given_back.empty(); };
  return some(without.changes) || some(without.patch.changes);
}

// The scene as it is written without the object: those shown, but for what leaves with it, and what is added.
std::shared_ptr<const CleanObject> rest_to_draw(const GaussianCloud& scene,
                                                const std::vector<std::uint8_t>& shown,
                                                const SceneWithout& without) {
  RestChanges changes = without.changes;
  add(without.patch.changes, &changes);
  std::vector<std::uint8_t> stays = shown;
  for (const std::uint32_t g : changes.ghosts) stays[g] = 0;
  CleanObject out;
  out.gaussian = labelled_rows(stays);
  out.gaussian.resize(out.gaussian.size() + changes.given_back.size(), kNoGaussian);
  out.cloud = rest_of(scene, shown, changes);
  return std::make_shared<const CleanObject>(std::move(out));
}

Flags kept_if_equal(const Flags& before, const Flags& fresh) {
  const bool equal = before && fresh ? *before == *fresh : before == fresh;
  return equal ? before : fresh;
}

}  // namespace

Styles styled(const StyleOrder& order, const Styles& before, LabelCache* labels, const Job& job) {
  const std::size_t n = order.cloud->size();
  const Document& document = order.document;
  FrameStyle style;
  style.background = document.background;
  style.checker_px = order.view.checker ? std::round(kCheckerPoints * order.pixels_per_point) : 0;
  style.tint = order.view.tint;
  style.outline = order.view.outline;
  std::vector<std::uint8_t> owner(n, 0);
  Flags active, hidden;
  std::uint8_t chosen = 0;  // number of the active object, whose tint lies over the others'
  bool any = false;
  for (std::size_t i = 0; i < document.objects.size(); ++i) {
    const ObjectItem& object = document.objects[i];
    const auto preview = order.previews.find(object.id);
    const Flags own = preview != order.previews.end() ? with_cut(document, object, preview->second)
                                                      : labels->labels(document, object, n);
    const auto number = static_cast<std::uint8_t>(i + 1);
    style.owner_colour[number] = object.colour;
    for (std::size_t g = 0; object.tinted && g < n; ++g)
      if ((*own)[g]) owner[g] = number;
    any |= object.tinted;
    if (std::ranges::find(order.view.hidden, object.id) != order.view.hidden.end())
      hidden = hidden ? make_flags(combined(*hidden, *own, SetOperation::kAdd)) : own;
    if (object.id != document.active) continue;
    active = own;
    if (object.tinted) chosen = number;
  }
  for (std::size_t g = 0; chosen != 0 && g < n; ++g)
    if ((*active)[g]) owner[g] = chosen;
  if (any) style.owner = make_flags(std::move(owner));
  if (!active) active = make_flags(std::vector<std::uint8_t>(n, 0));
  if (shows_seen_heat(order.view))
    style.heat = order.seen && order.seen->is_of(active, document.up_world) ? order.seen->heat : nullptr;
  else if (order.view.heat)
    style.heat = order.likelihood;
  Styles out;
  out.active_labels = active;
  if (order.floaters) {
    Selection found = floaters(*order.cloud, order.graph->get(job), *active);
    out.floaters = count_flags(found);
    style.highlight = make_flags(std::move(found));
  } else if (order.range) {
    const auto* colour = std::get_if<SelectColour>(&*order.range);
    const auto* range = std::get_if<SelectRange>(&*order.range);
    style.highlight =
        make_flags(colour ? select_colour(*order.cloud, colour->colour, colour->tolerance)
                          : select_range(property_values(*order.cloud, range->property, &order.camera),
                                         range->low, range->high));
  }
  const bool compares = order.view.display == DisplayMode::kBeforeAfter;
  const bool two = order.view.display == DisplayMode::kSideBySide || compares;
  const bool alone = order.view.display == DisplayMode::kIsolate || compares;
  FrameStyle plain = style;
  plain.owner = nullptr;
  const auto shown = [&](std::size_t pane, DisplayMode mode) {
    out.shown[pane] = kept_if_equal(before.shown[pane], shown_in(mode, document, active, hidden));
  };
  out.panes = two ? 2 : 1;
  out.display = order.view.display;
  shown(0, compares ? DisplayMode::kIsolate : two ? DisplayMode::kWhole : order.view.display);
  out.style[0] = alone && !style.highlight ? plain : style;
  if (two) {
    shown(1, DisplayMode::kIsolate);
    out.style[1] = plain;
    out.style[1].heat = nullptr;
  }
  if (shows_filled_hole(order.view) && n <= kMostToCopy) {
    out.without = order.clean->known_without(leaving_of(document, active, order.view));
    out.unfinished = !out.without;
    if (!out.without && mostly_same(before.active_labels, active)) out.without = before.without;
    const bool same = out.without == before.without && out.shown[0] == before.shown[0] &&
                      before.display == DisplayMode::kHide;
    if (out.without && changes_rest(*out.without))
      out.clean[0] = same ? before.clean[0] : rest_to_draw(*order.cloud, *out.shown[0], *out.without);
  }
  if (!shows_clean_edges(order.view)) return out;
  const std::size_t pane = two ? 1 : 0;
  auto clean = order.clean->known(active, document.up_world);
  out.unfinished = !clean;
  if (clean && !clean->report.cleaned) return out;
  if (!clean && !before.without)
    clean = carried_over(before.clean[pane], before.active_labels, active, *order.cloud);
  if (clean) {
    out.clean[pane] = clean;
    out.shown[pane] = kept_if_equal(before.shown[pane], shown_of(*clean, n));
  }
  return out;
}

}  // namespace splatcut
