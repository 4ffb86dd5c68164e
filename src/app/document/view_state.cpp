#include "app/document/view_state.h"

#include <fmt/format.h>

namespace splatcut {

ViewState turned_over(ViewState view, DisplayMode mode) {
  view.display = view.display == mode ? DisplayMode::kWhole : mode;
  return view;
}

ViewState turned_hide(ViewState view, ObjectId chosen) {
  if (view.display == DisplayMode::kHide) std::erase(view.hidden, chosen);
  return turned_over(view, DisplayMode::kHide);
}

ViewState turned_eye(ViewState view, ObjectId object, ObjectId chosen) {
  const bool shows_again = hides(view, object, chosen);
  if (object == chosen && view.display == DisplayMode::kHide) view.display = DisplayMode::kWhole;
  std::erase(view.hidden, object);
  if (!shows_again) view.hidden.push_back(object);
  return view;
}

ViewState turned_side_by_side(ViewState view) {
  const DisplayMode before = view.display;
  view.display = before == DisplayMode::kIsolate       ? DisplayMode::kBeforeAfter
                 : before == DisplayMode::kBeforeAfter ? DisplayMode::kIsolate
                 : before == DisplayMode::kSideBySide  ? DisplayMode::kWhole
                                                       : DisplayMode::kSideBySide;
  return view;
}

ViewState turned_seen_heat(ViewState view) {
  if (shows_seen_heat(view)) {
    view.display = *view.seen_heat;
    view.seen_heat.reset();
  } else {
    view.seen_heat = view.display;
    view.display = DisplayMode::kIsolate;
  }
  return view;
}

ViewState turned_fill_hole(ViewState view) {
  view.fill_hole = !shows_filled_hole(view);
  if (view.fill_hole) show(DisplayMode::kHide, &view);
  return view;
}

std::string label_of(const ViewState& view, const ShownObject& object) {
  if (shows_seen_heat(view))
    return object.heat      ? "Seen by views: red none, blue many  (Shift+M: back)"
           : object.looking ? "Looking who saw it...  (Esc: stop)"
                            : "Who saw it is not known  (Shift+M: back)";
  if (view.display == DisplayMode::kIsolate)
    return fmt::format("Only {}{}  (I: back)", object.name, object.clean ? ", edges cleaned" : "");
  if (view.display == DisplayMode::kHide)
    return fmt::format("Without {}{}  (H: back)", object.name,
                       object.filled && object.outlined ? "; outlined: filled, invented"
                       : object.filled                  ? ", its hole filled"
                       : object.outlined                ? "; outlined: ground no view saw"
                                                        : "");
  if (view.heat) return "Likelihood: blue rest, red object  (M: back)";
  const bool some = view.display == DisplayMode::kWhole && !view.hidden.empty();
  return some ? "Without hidden objects  (Shift+H: back)" : "";
}

}  // namespace splatcut
