#include "app/document/view_state.h"

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

const char* label_of(const ViewState& view, const ShownObject& object) {
  if (shows_seen_heat(view))
    return object.heat      ? "Seen by views: red none, blue many  (Shift+M: back)"
           : object.looking ? "Looking who saw it...  (Esc: stop)"
                            : "Who saw it is not known  (Shift+M: back)";
  if (view.display == DisplayMode::kIsolate)
    return !object.clean ? "Only the object  (I: back)" : "Only the object, edges cleaned  (I: back)";
  if (view.display == DisplayMode::kHide)
    return object.filled && object.outlined ? "Without it; outlined: filled, invented  (H: back)"
           : object.filled                  ? "Without the object, its hole filled  (H: back)"
           : object.outlined                ? "Without it; outlined: ground no view saw  (H: back)"
                                            : "Without the object  (H: back)";
  if (view.heat) return "Likelihood: blue rest, red object  (M: back)";
  return view.display == DisplayMode::kWhole && !view.hidden.empty()
             ? "Without hidden objects  (Shift+H: back)"
             : nullptr;
}

}  // namespace splatcut
