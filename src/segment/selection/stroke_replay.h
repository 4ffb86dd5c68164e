// All strokes on one object, in their order and in any views, as one selection of parts.
//
// In: strokes with their cameras. Out: labels, and the Gaussians that the strokes themselves decide, see
// click_selection.h. All views count alike; the first one only decides what the first click can mean. Views
// are looked at no wider than asked for, or wider where the object is small in them. The strokes of the last
// replay are kept: one more stroke costs one stroke. The result depends on the strokes alone.
#pragma once

#include <list>
#include <memory>
#include <span>
#include <vector>

#include "segment/selection/click_selection.h"

namespace splatcut {

struct CameraStroke {
  Camera camera;
  Stroke stroke;         // in the camera's pixels
  SeenGaussians seen{};  // it affects these alone; null: all
};

struct ReplayOptions {
  SelectionModel model;
  int part_step = 0;         // see ClickSelection
  int choice = 0;            // see ClickSelection
  int work_width_px = 320;   // views are rasterised no wider than this
  int least_object_px = 48;  // square root of its pixels: wider where the object shows fewer
  bool operator==(const ReplayOptions&) const = default;
};

// The order in which strokes are applied: the first one on the object, then all others as they were made, as
// strokes on the background correct an object.
std::vector<CameraStroke> in_replay_order(std::span<const CameraStroke> strokes);

class StrokeReplay {
 public:
  // parts must outlive this.
  explicit StrokeReplay(const PartHierarchy& parts) : parts_(parts) {}

  // Cancelled: the selection must not be used. The result is valid until the next call.
  const ClickSelection& replay(const Drawer& drawer, std::span<const CameraStroke> strokes,
                               const ReplayOptions& options, const Job& job = {});

 private:
  struct KnownView {
    LeafView view;
    SeenGaussians seen;
  };
  // The view of the Gaussians that the stroke affects. Null if cancelled.
  const LeafView* view(const Drawer& drawer, const CameraStroke& said, int width_px, const Job& job);
  std::shared_ptr<const ClickSelection> after(const Drawer& drawer, const ClickSelection& before,
                                              const CameraStroke& said, const Job& job);

  const PartHierarchy& parts_;
  std::list<KnownView> views_;  // the newest first
  ReplayOptions options_;
  std::vector<CameraStroke> done_;  // in the order in which they were applied
  std::vector<std::shared_ptr<const ClickSelection>>
      after_;  // the selection after each of them; null: no longer kept
  std::shared_ptr<const ClickSelection> last_;
};

}  // namespace splatcut
