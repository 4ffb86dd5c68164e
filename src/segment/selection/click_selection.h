// What clicks and strokes mean: a label per Gaussian that grows with each of them, in any view.
//
// In: the hierarchy of parts, and one stroke after the other with the view it was made in. Out: labels (1 =
// object), and which Gaussians the strokes themselves have decided.
// A click says two things. Certain: what is displayed around it is on the wrong side now. Within a disc of
// disc_share times the distance to where the wrong region may end (the displayed border, or a jump of the
// depth before it), Gaussians that show mostly there take the said label and keep it until a later disc of
// the other sign covers them; so do leaves that lie mostly in the disc. Probable: one of the clicked leaf's
// ancestors in any tree is meant, the one of the least cost; see candidates.h. A leaf follows a correction
// only where, in most trees, it meets no click of the other sign below its common ancestor with this click.
// After one object click, a click on the rest may also say that another part of that click was meant: the
// likeliest that holds none of the clicks on the rest. Where no candidate is likely the disc alone changes.
// A box says what is meant as a whole (box_meanings.h): the likeliest part of each tree votes for its leaves
// (part_votes.h), and those of more than half of the votes change side, unless a click has decided them. It
// decides no Gaussian by itself: clicks correct it anywhere.
// Cost: some 10 ms a click once its view is known. The result depends on the strokes in their order alone.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "segment/masks/seeds.h"
#include "segment/selection/candidates.h"
#include "segment/selection/leaf_view.h"
#include "segment/superpoints/part_model.h"

namespace splatcut {

inline constexpr int kMostMeanings = 3;  // of a first click that are offered

class ClickSelection {
 public:
  // choice: which meaning of the first click is taken, 0 the likeliest; see meanings(). part_step: how many
  // sizes above or below that meaning's own. Both are clamped to what there is.
  ClickSelection(const PartHierarchy& parts, const SelectionModel& model, int part_step = 0, int choice = 0);

  // Applies a stroke, given in the view's pixels. False if it hits nothing of the scene, or marks background
  // before there is an object.
  bool apply(const LeafView& view, const Stroke& stroke);

  // The candidates of a click on this pixel. Nothing if it misses the scene, or the pixel shows that label
  // already.
  std::optional<Answers> considered(const LeafView& view, const glm::vec2& pixel, bool object,
                                    const AnswerOptions& options = {}) const;
  void set_model(const SelectionModel& model) { model_ = model; }  // for the clicks to come
  const SelectedParts& selected() const { return selected_; }

  bool any() const { return any_; }                                    // some stroke has hit the scene
  const std::vector<std::uint8_t>& labels() const { return labels_; }  // per Gaussian
  const std::vector<std::int8_t>& said() const { return said_; }  // per Gaussian: +1, -1: by a disc; or 0

  // Sizes that the first click can mean: how many, the one taken, whether another was nearly as likely.
  std::size_t sizes() const { return sizes_; }
  std::size_t size() const { return size_; }
  std::size_t likeliest_size() const { return likeliest_size_; }  // at part_step 0
  // What the next smaller and the next larger size would show in the first click's view; empty: there is
  // none.
  const Mask& smaller() const { return next_sizes_->smaller; }
  const Mask& larger() const { return next_sizes_->larger; }
  bool ambiguous() const { return ambiguous_; }

  // A mask for each meaning of the first click that is nearly as likely as the best and looks clearly
  // different in its view, the likeliest first; at most kMostMeanings. Empty before the first click. Those of
  // a box are what the trees agree on, then single parts.
  std::span<const Mask> meanings() const;
  std::size_t choice() const { return choice_taken_; }

  // The last stroke changed its disc alone: no part fitted it.
  bool spot_alone() const { return spot_alone_; }

 private:
  struct Asked;
  Asked asked(const LeafView& view, const glm::vec2& pixel, bool object) const;
  bool take(const LeafView& view, const glm::vec2& pixel, bool object, float least_radius_px);
  bool take_box(const LeafView& view, const Stroke& box);
  void confirm(const LeafView& view, const glm::vec2& pixel, bool object, float least_radius_px);
  std::vector<std::uint8_t> certain_leaves(const LeafView& view, std::span<const std::uint32_t> disc) const;
  float displayed_radius(const LeafView& view, const Mask& displayed, const glm::ivec2& at, bool object,
                         std::uint32_t leaf) const;
  std::vector<std::uint32_t> disc(const Camera& camera, const glm::ivec2& at, float radius_px,
                                  float least_radius_px) const;
  void note_offers(const LeafView& view, const Answers& answers);
  void note_first(const LeafView& view, const Answers& answers, Candidate* best);
  Mask shown_at(const LeafView& view, const Answers& answers, Candidate candidate, std::size_t index) const;
  void change_leaves(const Answers& answers, const Candidate& best, const std::vector<std::uint8_t>& certain,
                     const Click& click);
  enum class Pin { kAll, kSaidAlready };
  void pin(const LeafView& view, std::span<const std::uint32_t> pixels, bool object, Pin which = Pin::kAll);
  void insist(const LeafView& view, std::size_t pixel, bool object);
  void label();

  const PartHierarchy& parts_;
  SelectionModel model_;
  int part_step_, choice_;
  SelectedParts selected_;
  struct Offers {
    std::vector<Candidate> meant;
    std::vector<Mask> masks;  // of each, in the first click's view
  };
  std::shared_ptr<const Offers> offers_;
  struct NextSizes {
    Mask smaller, larger;
  };
  std::shared_ptr<const NextSizes> next_sizes_ = std::make_shared<const NextSizes>();
  std::vector<std::uint8_t> labels_;
  std::vector<std::int8_t> said_;
  bool any_ = false;
  std::size_t sizes_ = 0, size_ = 0, likeliest_size_ = 0, choice_taken_ = 0;
  bool ambiguous_ = false, spot_alone_ = false;
};

}  // namespace splatcut
