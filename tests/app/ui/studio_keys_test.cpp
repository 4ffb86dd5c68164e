// Every key of the F1 page does what the page says.
#include <doctest/doctest.h>

#include <functional>
#include <map>

#include "headless_app.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// What must hold after the key; taken before is the state before it.
struct Before {
  Document document;
  ViewState view;
  CameraPose pose;
  std::size_t selected = 0, history = 0, messages = 0;
  std::uint64_t serial = 0;
  bool dark = true, floaters = false;
};

using Check = std::function<bool(HeadlessApp&, const Before&)>;

Before taken(HeadlessApp& app) {
  Studio& s = app.studio();
  return {s.document(),
          s.view(),
          s.camera().pose(),
          s.gaussians_of(s.document().active),
          s.history().entries().size(),
          s.messages().size(),
          s.history().serial(),
          app->interface().state().dark,
          s.viewport().floaters_shown()};
}

int size_step(HeadlessApp& app) {
  return last_stroke(app.studio().document().active_object()->views)->size_step;
}

Check tool_is(const Tool& tool) {
  return [tool](HeadlessApp& app, const Before&) { return app.studio().view().tool == tool; };
}
Check shows(DisplayMode mode) {
  return [mode](HeadlessApp& app, const Before&) { return app.studio().view().display == mode; };
}
Check view_changed(bool ViewState::*flag) {
  return [flag](HeadlessApp& app, const Before& before) {
    return app.studio().view().*flag != before.view.*flag;
  };
}
Check selected(const std::function<bool(std::size_t now, std::size_t before, std::size_t all)>& holds) {
  return [holds](HeadlessApp& app, const Before& before) {
    REQUIRE(app.settle());
    Studio& s = app.studio();
    return holds(s.gaussians_of(s.document().active), before.selected, s.scene()->cloud->size());
  };
}
Check dialog() {
  return [](HeadlessApp& app, const Before&) {
    app.frames(2);
    const bool open = app->interface().dialog_open();
    app.key(key::kEscape);
    app.frames(2);
    return open && !app->interface().dialog_open();
  };
}
bool camera_moved(HeadlessApp& app, const Before& before) {
  app.frames(40);
  const CameraPose& now = app.studio().camera().pose();
  return now.position_world != before.pose.position_world || now.distance != before.pose.distance;
}
bool moved_along(HeadlessApp& app, const Before& before, int axis, float sign) {
  const CameraPose& now = app.studio().camera().pose();
  const glm::vec3 moved = now.position_world - before.pose.position_world;
  const glm::mat3 camera_from_world = glm::mat3_cast(before.pose.camera_from_world);
  return sign * (camera_from_world * moved)[axis] > 0;
}
Check flies(int axis, float sign) {
  return [=](HeadlessApp& app, const Before& before) { return moved_along(app, before, axis, sign); };
}

const std::map<Action, Check> kChecks = {
    {Action::kOpen, dialog()},
    {Action::kAddScene, dialog()},
    {Action::kSave, dialog()},
    {Action::kExport, dialog()},
    {Action::kSnapshot, dialog()},
    {Action::kHelp, dialog()},
    {Action::kSettings, dialog()},
    {Action::kQuit, dialog()},  // asks, as the work is not saved
    {Action::kUndo, [](HeadlessApp& app, const Before&) { return app.studio().history().can_redo(); }},
    {Action::kRedo, [](HeadlessApp& app, const Before&) { return !app.studio().history().can_redo(); }},
    {Action::kCancel,
     [](HeadlessApp& app, const Before&) {
       app.key('5');  // the brush; the first Esc took the offer away
       app.key(key::kEscape);
       return app.studio().view().tool == Tool::kClick;
     }},
    {Action::kCursor, [](HeadlessApp& app, const Before&) { return app.studio().cursor_px().has_value(); }},
    {Action::kConfirm, selected([](auto now, auto before, auto) { return now > before; })},
    {Action::kRecompute,
     [](HeadlessApp& app, const Before&) { return app.studio().cutting() && app.settle(); }},
    {Action::kTheme,
     [](HeadlessApp& app, const Before& b) { return app->interface().state().dark != b.dark; }},
    {Action::kHistory,
     [](HeadlessApp& app, const Before&) {
       app.frames(2);
       return app->interface().state().history_open;
     }},
    {Action::kSelectAll, selected([](auto now, auto, auto all) { return now == all; })},
    {Action::kSelectNone, selected([](auto now, auto, auto) { return now == 0; })},
    {Action::kInvert, selected([](auto now, auto before, auto all) { return now == all - before; })},
    {Action::kGrow, selected([](auto now, auto before, auto) { return now > before; })},
    {Action::kShrink, selected([](auto now, auto before, auto) { return now < before; })},
    {Action::kLargestPart, selected([](auto now, auto before, auto) { return now > 0 && now <= before; })},
    {Action::kFloaters,
     [](HeadlessApp& app, const Before& b) {  // shown until it turns out that there are none
       const auto& messages = app.studio().messages();
       return app.studio().viewport().floaters_shown() != b.floaters ||
              (!messages.empty() && messages.back().text == "Nothing floats apart from the object");
     }},
    {Action::kSeeThrough, view_changed(&ViewState::see_through)},
    {Action::kByCentre, view_changed(&ViewState::by_centre)},
    {Action::kDelete,
     [](HeadlessApp& app, const Before& b) {
       return app.settle() && app.studio().document().deleted &&
              count_flags(*app.studio().document().deleted) == b.selected;
     }},
    {Action::kNewObject,
     [](HeadlessApp& app, const Before& b) {
       return app.studio().document().objects.size() == b.document.objects.size() + 1;
     }},
    {Action::kBrushSmaller,
     [](HeadlessApp& app, const Before& b) { return app.studio().view().brush_px < b.view.brush_px; }},
    {Action::kBrushLarger,
     [](HeadlessApp& app, const Before& b) { return app.studio().view().brush_px > b.view.brush_px; }},
    {Action::kPartLarger, [](HeadlessApp& app, const Before&) { return size_step(app) == 1; }},
    {Action::kPartSmaller, [](HeadlessApp& app, const Before&) { return size_step(app) == -1; }},
    {Action::kIsolate, shows(DisplayMode::kIsolate)},
    {Action::kHide, shows(DisplayMode::kHide)},
    {Action::kShowAll, shows(DisplayMode::kWhole)},
    {Action::kSideBySide, shows(DisplayMode::kSideBySide)},
    {Action::kFillHole, view_changed(&ViewState::fill_hole)},
    {Action::kCleanEdges, view_changed(&ViewState::clean_edges)},
    {Action::kTint, view_changed(&ViewState::tint)},
    {Action::kOutline, view_changed(&ViewState::outline)},
    {Action::kHeat,
     [](HeadlessApp& app, const Before&) {
       return app.settle() && app.studio().viewport().style(0).heat != nullptr;
     }},
    {Action::kSeenHeat,
     [](HeadlessApp& app, const Before&) {
       return app.settle() && app.studio().viewport().style(0).heat != nullptr &&
              app.studio().view().display == DisplayMode::kIsolate;
     }},
    {Action::kBackdrop,
     [](HeadlessApp& app, const Before& b) {
       return app.studio().document().background != b.document.background;
     }},
    {Action::kCentres, view_changed(&ViewState::centres)},
    {Action::kRings, view_changed(&ViewState::rings)},
    {Action::kGrid, view_changed(&ViewState::grid)},
    {Action::kViewFront, camera_moved},
    {Action::kViewRight, camera_moved},
    {Action::kViewTop, camera_moved},
    {Action::kFrameObject, camera_moved},
    {Action::kFrameScene, camera_moved},
    {Action::kOpeningView, camera_moved},
    {Action::kNextCamera, camera_moved},
    {Action::kPreviousCamera, camera_moved},
    {Action::kFlyForward, flies(2, 1)},
    {Action::kFlyBack, flies(2, -1)},
    {Action::kFlyLeft, flies(0, -1)},
    {Action::kFlyRight, flies(0, 1)},
    {Action::kFlyUp, flies(1, -1)},
    {Action::kFlyDown, flies(1, 1)},
};

// Some keys need something to act on.
void arrange(HeadlessApp& app, Action action) {
  Studio& s = app.studio();
  if (action == Action::kRedo) s.apply(Undo{});
  if (action == Action::kPartLarger || action == Action::kPartSmaller) {
    s.apply(JumpHistory{1});
    app.click(app.screen_of(kOnApple));
  }
  if (action == Action::kOpeningView) s.camera().zoom(-4);
  if (action == Action::kShowAll) s.run(Action::kIsolate);
  if (action == Action::kConfirm) {
    s.run(Action::kToolPolygon);
    const UiRect view = app->interface().viewport();
    app.click(view.min + glm::vec2(40, 120));
    app.click(view.min + glm::vec2(160, 120));
    app.click(view.min + glm::vec2(100, 200));
  }
  app.frames(2);
}

}  // namespace

TEST_CASE("every key of the F1 page does what the page says") {
  HeadlessApp app(760, 420);
  REQUIRE(cut_out_apple(app));
  for (const Binding& binding : key_bindings()) {
    const Tool* tool = tool_of(binding.action);
    const Check check = tool ? tool_is(*tool) : kChecks.at(binding.action);  // a key without a check is a gap
    Studio& s = app.studio();
    s.apply(JumpHistory{1});  // the apple's click, its cutout computed
    s.apply(SetView{});
    s.apply(ShowFloaters{false});
    s.camera().go_to(s.scene()->views().cameras.front());
    s.camera().finish_transition();
    app->interface().state().history_open = false;
    REQUIRE(app.settle());
    arrange(app, binding.action);
    const Before before = taken(app);
    app.key(binding.key, binding.modifiers);
    const std::string said = s.messages().empty() ? "" : s.messages().back().text;
    CHECK_MESSAGE(check(app, before),
                  binding.what << " (" << key_name(binding.key, binding.modifiers) << "), it said: " << said);
  }
}
