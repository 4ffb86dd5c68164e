// What clicks and strokes mean: a label per Gaussian that grows with each of them, in any view.
//
// In: the hierarchy of parts, and one stroke after the other with the view it was made in. Out: labels (1 =
// object), and which Gaussians the strokes themselves have decided.
// A click says two things. Certain: what is displayed around it is on the wrong side now. Within a disc of
// disc_share times the distance to the displayed border, Gaussians that show mostly there take the said label
// and keep it until a later disc of the other sign covers them; so do leaves that lie mostly in the disc.
// Probable: one of the clicked leaf's ancestors in any tree is meant, the one of the least cost; see
// candidates.h. A leaf follows a correction only where, in most trees, it meets no click of the other sign
// below its common ancestor with this click. After one object click, a click on the rest may also say that
// another part of that click was meant: the likeliest that holds none of the clicks on the rest. Where no
// candidate is likely the disc alone changes. Cost: some 10 ms a click once its view is known. The result
// depends on the strokes in their order alone.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "segment/part_model.h"
#include "segment/seeds.h"
#include "segment/selection/candidates.h"
#include "segment/selection/leaf_view.h"

namespace splatcut {

class ClickSelection {
 public:
  // part_step: along the sizes that the first click can mean, from the likeliest; +1 the next larger.
  ClickSelection(const PartHierarchy& parts, const SelectionModel& model, int part_step = 0);

  // A stroke in the pixels of the view. False: nothing of the scene is under it, or it speaks of the rest
  // before there is an object.
  bool apply(const LeafView& view, const Stroke& stroke);

  // What a click here could mean. Nothing: the scene is not hit, or shows what is said already.
  std::optional<Answers> considered(const LeafView& view, const glm::vec2& pixel, bool object,
                                    const AnswerOptions& options = {}) const;
  void set_model(const SelectionModel& model) { model_ = model; }  // for the clicks to come
  const SelectedParts& selected() const { return selected_; }

  const std::vector<std::uint8_t>& labels() const { return labels_; }  // per Gaussian
  const std::vector<std::int8_t>& said() const { return said_; }       // per Gaussian: +1, -1, 0 = by no disc

  // What the first click can mean: how many sizes, the one taken, and whether another one was nearly as
  // likely.
  std::size_t sizes() const { return sizes_; }
  std::size_t size() const { return size_; }
  bool ambiguous() const { return ambiguous_; }

 private:
  struct Asked;
  Asked asked(const LeafView& view, const glm::vec2& pixel, bool object) const;
  bool take(const LeafView& view, const glm::vec2& pixel, bool object, float least_radius_px);
  void confirm(const LeafView& view, const glm::vec2& pixel, bool object, float least_radius_px);
  std::vector<std::uint8_t> certain_leaves(const LeafView& view, std::span<const std::uint32_t> disc) const;
  void note_first(const std::vector<Chain>& chains, std::span<const Candidate> candidates, Candidate* best);
  void change_leaves(const Answers& answers, const Candidate& best, const std::vector<std::uint8_t>& certain,
                     const Click& click);
  void pin(const LeafView& view, std::span<const std::uint32_t> pixels, bool object);
  void insist(const LeafView& view, std::size_t pixel, bool object);
  void label();

  const PartHierarchy& parts_;
  SelectionModel model_;
  int part_step_;
  SelectedParts selected_;
  std::vector<std::uint8_t> labels_;
  std::vector<std::int8_t> said_;
  bool any_ = false;
  std::size_t sizes_ = 0, size_ = 0;
  bool ambiguous_ = false;
};

}  // namespace splatcut
