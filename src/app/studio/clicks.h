// Clicks and scribbles: what they hit, what the next one would change, what else the first one can mean.
#pragma once

#include <optional>
#include <string>

#include "app/studio/cut_jobs.h"
#include "app/studio/edits.h"
#include "app/studio/viewport.h"
#include "app/studio/workspace.h"

namespace splatcut {

class Clicks {
 public:
  Clicks(Workspace& workspace, Viewport& viewport, const CutJobs& cuts, Edits& edits)
      : ws_(workspace), viewport_(viewport), cuts_(cuts), edits_(edits) {}

  void reset();   // another scene
  void update();  // once a frame: the outline under the pointer, what a click needs, the sizes of a new cut
  void pointer_inside(bool inside) { pointer_inside_ = inside; }  // of the viewport

  // Other meanings of the active object's first click, offered until it gets another stroke; null: none.
  const ClickMeanings* offer() const;
  bool decline_offer();  // false where there is none
  // The sizes beside the one that the wheel is at, for a while after the click or the last step; and how
  // clearly they show, from 1 to 0.
  const ClickMeanings* sizes() const;
  float sizes_opacity() const;
  // True if the active object's clicks found nothing, mostly for being made from too far away.
  bool found_nothing() const;
  // A refusal if the first click has no part that many sizes larger, as far as is known; else empty.
  std::string why_not_step(int steps) const;

  void perform(const AddStroke& c);
  void perform(const StepScale& c);
  void perform(const ComeNearer&);
  // What strokes alone would cut out, taken from the object or kept of it.
  void perform(const IntersectStroke& c);
  void perform(const AddBox& c);

 private:
  // Asked of the worker, or shown already.
  struct HoverAsk {
    std::uint64_t document = 0, view = 0;  // serials
    Camera camera;
    glm::vec2 pixel{0};
    bool rest = false;
    bool same_but_pixel(const HoverAsk& other) const {
      return document == other.document && view == other.view && rest == other.rest &&
             same_camera(camera, other.camera);
    }
  };

  bool hits_anything(const AddStroke& c) const;
  std::string already_so(const AddStroke& c) const;
  const ClickMeanings* meanings(const ObjectItem& object) const;
  std::optional<HoverAsk> hover_wanted() const;
  bool asks_ahead() const;
  void refresh_hover();
  void make_middle_ready();
  void show_hover(const Flags& change, bool rest);
  void combine_with(const CameraStroke& stroke, SetOperation operation, const std::string& title);
  void note_sizes();

  Workspace& ws_;
  Viewport& viewport_;
  const CutJobs& cuts_;
  Edits& edits_;
  std::optional<HoverAsk> hover_;
  std::optional<Camera> ready_;  // what its middle shows has been made ready for a click, or is being
  std::string declined_offer_;   // its key
  double stepped_s_ = -1e9;      // when a size was chosen last, or a click found some
  std::uint64_t cuts_done_ = 0;  // see CutJobs::done()
  bool pointer_inside_ = false;
};

}  // namespace splatcut
