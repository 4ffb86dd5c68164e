// Clicks, scribbles and boxes: what they hit, what the next click would change, what else the first one can
// mean.
#pragma once

#include <optional>
#include <string>

#include "app/studio/edits.h"
#include "app/tools/actions.h"
#include "app/workspace/cut_jobs.h"
#include "app/workspace/viewport.h"
#include "app/workspace/workspace.h"

namespace splatcut {

class Clicks {
 public:
  Clicks(Workspace& workspace, Viewport& viewport, CutJobs& cuts, Edits& edits)
      : ws_(workspace), viewport_(viewport), cuts_(cuts), edits_(edits) {}

  void reset();  // forgets everything of the last scene
  // Updates the outline under the pointer, prepares a click in the middle of the picture, notes sizes of a
  // new cut, and has those next to it cut ahead. Called once a frame.
  void update();
  void pointer_inside(bool inside) { pointer_inside_ = inside; }  // says if the pointer is in the viewport

  // Meanings of the active object's first click or box, offered until the object gets another stroke or is
  // empty; null: no offer.
  const ClickMeanings* offer() const;
  bool offer_comes() const;  // true: it is still computed whether there is one
  // Why the key of the tool Click takes no other meaning although its tool is chosen: a sentence; empty: it
  // is not expected to.
  std::string why_no_meanings() const;
  // True if the key, without others, is for those meanings, not for a tool, also where they are to come.
  bool chooses_by(int key) const;
  // True if it is pressed for one that the click does not have: no tool was chosen since, and it was not
  // said.
  bool lacks_meaning(int key) const;
  std::string why_no_meaning(Action pressed = Action::kNone) const;  // pressed: what its key does instead
  std::string why_not_choose(int choice) const;  // refusal if no such meaning is offered; else empty
  bool decline_offer();  // withdraws the offer, also one that is hidden; returns false if none was shown
  // Sizes that the active object's last click can have; null: they are not known, or it has none.
  // size_wanted(): the one that the document asks for, which StrokeSizes::size becomes once it is computed.
  const StrokeSizes* known_sizes() const;
  std::size_t size_wanted() const;
  // The same while the pointer stays on the dot of that click, and for a while after a step of the wheel,
  // when the size wanted and those next to it show; null: none show. Beside the dot the wheel takes them,
  // too, and what shows is what a click there would change.
  const StrokeSizes* sizes() const;
  float sizes_opacity() const;  // opacity of sizes(), from 1 to 0
  // The outline under the pointer is looked for, and longer than one takes for at once.
  bool looking() const;
  bool sizes_fade() const { return sizes() && !on_last_dot(); }              // true: it changes with time
  bool wheel_takes_sizes() const { return on_last_dot() && known_sizes(); }  // true: it does not zoom
  // Mark under the pointer, whose click one of the other label would take away; null: none.
  const StrokeMark* pointed_mark() const;
  // True if the active object's clicks found nothing, mostly because they were made from too far away.
  bool found_nothing() const;
  // Returns a refusal if the last click is known to have no part that many sizes larger; else empty.
  std::string why_not_step(int steps) const;

  void perform(const AddStroke& c);
  void perform(const RemoveStroke& c);
  void perform(const StepScale& c);
  void perform(const ComeNearer&);
  // Both commands may combine the object with what a stroke alone would cut out: keep of the object what both
  // hold, or remove it.
  void perform(const IntersectStroke& c);
  void perform(const AddBox& c);

 private:
  // Places of the picture that were prepared for a first click, those asked for last.
  struct Ready {
    std::optional<Camera> camera;
    std::optional<glm::vec2> pointer_px, middle_px;
  };
  // A question to the worker about the click under the pointer.
  struct HoverAsk {
    std::uint64_t document = 0, view = 0;  // serials of the document and of the view
    Camera camera;
    glm::vec2 pixel{0};
    bool rest = false;
    std::int32_t on = -1;                        // Gaussian under the pixel
    std::optional<SetOperation> by_colour = {};  // set: the click of a tool that goes by colour
    bool same_but_pixel(const HoverAsk& other) const {
      return document == other.document && view == other.view && rest == other.rest &&
             by_colour == other.by_colour && same_camera(camera, other.camera);
    }
  };

  std::string why_no_further(int steps) const;
  int step_that_changes(int step) const;
  bool hits_anything(const AddStroke& c) const;
  std::string already_so(const AddStroke& c) const;
  bool has_all(const Flags& seen) const;
  const ClickMeanings* meanings(const ObjectItem& object) const;
  const ClickMeanings* offered() const;
  const ObjectItem* object_of_offers() const;
  void forget_declined();
  std::optional<HoverAsk> hover_wanted() const;
  bool asks_ahead() const;
  bool can_ask() const;
  // The pointer is on the dot of the object's last stroke, in its view: elsewhere a wheel there zooms.
  bool on_last_dot() const;
  void refresh_hover();
  bool looks_only();
  void ask_by_colour(const HoverAsk& ask);
  void make_ready();
  void leave_what_came();
  void show_hover(const Flags& change, bool rest);
  void combine_with(const CameraStroke& stroke, SetOperation operation, const std::string& title);
  void note_sizes();
  void turn_about_cut();
  void cut_sizes_ahead();

  Workspace& ws_;
  Viewport& viewport_;
  CutJobs& cuts_;
  Edits& edits_;
  // Part of the view whose change ends outlines of hovering until the pointer moves.
  struct Look {
    DisplayMode display = DisplayMode::kWhole;
    bool checker = false;
    glm::vec3 background{0};
    friend bool operator==(const Look&, const Look&) = default;
  };
  // What a click would leave to others, the same for every place of the picture.
  struct HoverLeft {
    std::uint64_t document = 0;  // serial of the document
    Flags left;
  };
  HoverLeft hover_left_;
  std::optional<HoverAsk> hover_;           // question that was asked last; its answer may be shown already
  Look look_;                               // at the last update()
  glm::vec2 looked_px_{0};                  // pointer then
  std::optional<glm::vec2> looks_only_px_;  // pointer since look_ changed; none: it moved
  double hover_asked_s_ = 0;                // clock time at which hover_ was asked
  Ready ready_;
  std::string declined_offer_;   // ClickMeanings::key of the offer that was declined last
  double stepped_s_ = -1e9;      // clock time of the last choice of a size, or click that found some
  std::uint64_t cuts_done_ = 0;  // CutJobs::done() at the last update()
  bool pointer_inside_ = false;
  ObjectId turns_about_ = 0;  // object that the view turns around once it is cut; 0: none
};

}  // namespace splatcut
