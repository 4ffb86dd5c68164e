// Replay of all strokes on one object, in their order and in any views, into one selection of parts.
//
// In: strokes with their cameras. Out: labels, and the Gaussians that the strokes themselves decide, see
// click_selection.h. All views count alike; the first one only decides what the first click can mean. Views
// are rasterised no wider than asked for, or wider if the object is small in them, or if a correction's view
// crops it: then more than the view is looked at (wide_view.h). The replay keeps
// selections of the last replay, so that one more stroke costs one stroke. The result depends on the strokes
// and carried labels alone.
#pragma once

#include <list>
#include <memory>
#include <span>
#include <vector>

#include "segment/selection/box_by_colour.h"
#include "segment/selection/carried_labels.h"
#include "segment/selection/click_selection.h"
#include "segment/superpoints/usual_picture.h"

namespace splatcut {

struct CameraStroke {
  Camera camera;
  Stroke stroke;         // stroke in the camera's pixels
  SeenGaussians seen{};  // flags of the Gaussians that it affects; null: all
  bool earlier = false;  // true: it was made before the first one on the object
};

struct ReplayOptions {
  SelectionModel model;
  int choice = 0;            // number of the meaning of the first click, see ClickSelection
  int work_width_px = 320;   // greatest width of rasterised views, but see least_object_px
  int least_object_px = 48;  // least square root of the object's pixels: a view that shows fewer gets wider
  CarriedLabels carried{};
  bool operator==(const ReplayOptions&) const = default;
};

// Strokes in the order in which they are applied: the first one on the object, then all others as they were
// made. Strokes on the rest correct an object, so one has to come first.
std::vector<CameraStroke> in_replay_order(std::span<const CameraStroke> strokes);

class StrokeReplay {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;  // some 25 views at 320 pixels

  // parts and capture must outlive this. most_bytes: of the views that are kept; the last used one always is.
  explicit StrokeReplay(const PartHierarchy& parts, const Capture& capture = kUnknownCapture,
                        std::size_t most_bytes = kMostBytes)
      : parts_(parts), capture_(capture), most_bytes_(most_bytes) {}

  // Returns the selection after all strokes, which is valid until the next call. If cancelled, it must not be
  // used.
  const ClickSelection& replay(const Drawer& drawer, std::span<const CameraStroke> strokes,
                               const ReplayOptions& options, const Job& job = {});

  std::size_t view_bytes() const;  // of the views that are kept
  std::size_t bytes() const;       // of views and selections
  void forget();                   // all of these: the next replay begins anew

 private:
  struct KnownView {
    LeafView view;
    SeenGaussians seen;
    KnownByColour box{};  // the last one in it
  };
  // View of the Gaussians that the stroke affects; null if cancelled.
  KnownView* view(const Drawer& drawer, const CameraStroke& said, int width_px, const Job& job);
  // Selection after one more stroke, looked at in its own view or a wider one; null if cancelled.
  std::shared_ptr<const ClickSelection> after(const Drawer& drawer, const ClickSelection& before,
                                              const CameraStroke& said, const Job& job);

  std::shared_ptr<ClickSelection> after_in_view(const Drawer& drawer, const ClickSelection& before,
                                                const CameraStroke& said, int work_width_px, const Job& job);
  // True if the view is a close-up of what its pixel shows.
  bool close_up(const LeafView& view, const glm::vec2& pixel) const;

  const PartHierarchy& parts_;
  const Capture& capture_;
  std::size_t most_bytes_;
  std::list<KnownView> views_;  // views that are kept, the last used first
  ReplayOptions options_;
  std::vector<CameraStroke> done_;  // strokes in the order in which they were applied
  // Selection after each of them; null: it is no longer kept.
  std::vector<std::shared_ptr<const ClickSelection>> after_;
  std::shared_ptr<const ClickSelection> last_;
};

}  // namespace splatcut
