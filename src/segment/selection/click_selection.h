// Selection by clicks and other strokes: labels of the Gaussians that each stroke changes, in any view.
//
// In: the hierarchy of parts, and one stroke after the other with the view it was made in. Out: labels (1 =
// object), and the Gaussians that the strokes themselves have decided.
//
// A click says two things. Certain: what the view displays around it is on the wrong side now. This holds
// within a disc, whose radius is disc_share times the distance to where the wrong region may end: the
// displayed border, or a jump of the depth before it. Gaussians that show mostly in the disc take the said
// label, and keep it until a later disc of the other sign covers them; leaves that lie mostly in the disc do
// the same. Probable: the click means an ancestor of the clicked leaf in one of the trees, namely the one of
// the least cost, see candidates.h. A leaf follows a correction only if, in at least nearer_majority of the
// trees, it meets no click of the other sign below its common ancestor with this click.
//
// Where the trees end what a first click means differently, colour decides (settled_by_colour.h). Other
// meanings that are offered, and sizes, begin with what is settled so.
//
// A click's step takes a smaller or a larger size of what it means (part_sizes.h), of a correction of what it
// changes.
//
// A correction may also say that what was said first, click or box, meant another part, one that holds every
// click on the object and none on the rest: what the trees agree on, or after a click the likeliest if that
// is a small step from what is shown. If no candidate is likely, only the disc changes.
//
// A click on the rest may also find by colour what no part holds (region_by_colour.h). If the likeliest part
// changes less than half of that region, the region becomes rest, too, except for Gaussians that a click has
// decided. A click on the object takes it back, a leaf at a time. A scribble says itself how much is meant.
//
// A box says what is meant as a whole (box_meanings.h). The likeliest part of each tree votes for its leaves
// (part_votes.h); leaves with more than half of the votes change side, unless a click has decided them. A box
// decides no Gaussian by itself, so clicks can correct it anywhere.
//
// Cost: some 10 ms a click once its view is known. The result depends on the strokes and their order alone.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "segment/masks/seeds.h"
#include "segment/selection/candidates.h"
#include "segment/selection/leaf_view.h"
#include "segment/selection/part_sizes.h"
#include "segment/superpoints/part_model.h"

namespace splatcut {

inline constexpr int kMostMeanings = 3;  // limit of meanings of a first click that are offered

// What is known of a first stroke beside its view.
struct FirstStroke {
  bool close_up = false;  // the view is a close-up, see AnswerOptions
  // Leaves that a box means by colour; empty: leaves_by_colour() finds them.
  std::vector<std::uint8_t> by_colour;
};

class ClickSelection {
 public:
  // choice: number of the meaning of the first stroke to take, 0 the likeliest; see meanings(). It and
  // Stroke::size_step are clamped to what there is. parts must outlive this.
  ClickSelection(const PartHierarchy& parts, const SelectionModel& model, int choice = 0);

  // Applies a stroke, given in the view's pixels. Returns false if it hits nothing of the scene, or marks the
  // rest before there is an object.
  bool apply(const LeafView& view, const Stroke& stroke, const FirstStroke& first = {});

  // Candidates of a click on this pixel; none if it misses the scene, or if the pixel shows that label
  // already.
  std::optional<Answers> considered(const LeafView& view, const glm::vec2& pixel, bool object,
                                    const AnswerOptions& options = {}) const;
  void set_model(const SelectionModel& model) { model_ = model; }  // sets the model for strokes to come
  const SelectedParts& selected() const { return selected_; }

  bool any() const { return any_; }                                    // true: some stroke has hit the scene
  const std::vector<std::uint8_t>& labels() const { return labels_; }  // labels per Gaussian, 1 = object
  // Sign per Gaussian that a stroke has decided: +1 object, -1 rest; 0: no stroke has.
  const std::vector<std::int8_t>& said() const { return said_; }

  // Sizes of what the last stroke means (part_sizes.h): their number, the index of the one taken, and that at
  // step 0. A correction's sizes hold what it changes. None: it was a later scribble or box, or a click on
  // what showed its label already.
  std::size_t sizes() const { return sizes_.count; }
  std::size_t size() const { return sizes_.size; }
  std::size_t likeliest_size() const { return sizes_.likeliest; }
  std::span<const Mask> size_masks() const;  // of each size, in that stroke's view
  // Leaves of the masks of sizes what lies in this part of the last stroke's view.
  void crop_sizes(const PixelRect& part);
  // Gives each leaf the label that most of its Gaussians have, in place of what the strokes so far say.
  // Gaussians that discs have decided keep theirs. labels: per Gaussian, 1 = object.
  void carry(std::span<const std::uint8_t> labels);
  // The last stroke was made before one that is in `other` already: its sizes are those to choose from.
  void keep_sizes_of(const ClickSelection& other) { sizes_ = other.sizes_; }
  // How alike what was taken of the first stroke and all that it can mean are: certainty_of() in its view. 1
  // where another meaning or size was chosen, and before it.
  float certainty() const { return certainty_; }

  // Masks of the first click's meanings in its view, the likeliest first: those that are not far less likely
  // than the best and look clearly different, at most kMostMeanings. Empty before the first click. For a box,
  // the first is what the trees agree on, and the others are single parts.
  std::span<const Mask> meanings() const;
  std::size_t choice() const { return choice_taken_; }  // index of the meaning that is taken

  std::size_t bytes() const;  // what it takes, its masks of sizes and meanings among that

  // True if the last stroke changed its disc alone, because no part fitted it.
  bool spot_alone() const { return spot_alone_; }

 private:
  struct Asked;
  Asked asked(const LeafView& view, const glm::vec2& pixel, bool object) const;
  bool take(const LeafView& view, const glm::vec2& pixel, const Stroke& stroke, bool close_up);
  bool take_box(const LeafView& view, const Stroke& box, const FirstStroke& first);
  void confirm(const LeafView& view, const glm::vec2& pixel, bool object, float least_radius_px);
  std::vector<std::uint8_t> certain_leaves(const LeafView& view, std::span<const std::uint32_t> disc) const;
  float displayed_radius(const LeafView& view, const Mask& displayed, const glm::ivec2& at, bool object,
                         std::uint32_t leaf) const;
  std::vector<std::uint32_t> disc(const Camera& camera, const glm::ivec2& at, float radius_px,
                                  float least_radius_px) const;
  void note_offers(const LeafView& view, const Answers& answers, std::span<const PartMeaning> meanings);
  std::vector<std::uint8_t> first_leaves(const LeafView& view, const Answers& answers, int size_step);
  struct CorrectedPixels {
    std::span<const std::uint32_t> spot, by_colour;  // what a correction of any size, and of its own, changes
  };
  std::vector<std::uint8_t> note_sizes(const LeafView& view, const PartSizes& sizes, int step,
                                       const CorrectedPixels& pixels);
  void note_certainty(const LeafView& view, const std::vector<std::uint8_t>& taken);
  std::vector<std::uint8_t> corrected_leaves(const Click& click, const Answers& found,
                                             const std::vector<std::uint8_t>& meant,
                                             const CorrectedPixels& pixels, int size_step);
  std::vector<std::uint8_t> leaves_changed(const Answers& answers, const Candidate& candidate) const;
  void change_leaves(const std::vector<std::uint8_t>& meant, const std::vector<std::uint8_t>& certain,
                     const Click& click);
  std::vector<std::uint32_t> pixels_by_colour(const Click& click, const Answers& answers,
                                              std::span<const std::uint32_t> disc) const;
  std::vector<std::uint8_t> mostly_in(const LeafView& view, std::span<const std::uint32_t> pixels) const;
  void pin_by_colour(const LeafView& view, std::span<const std::uint32_t> pixels);
  void take_back_colour(std::span<const std::uint8_t> leaves);
  void take_back_colour_at(const LeafView& view, const glm::vec2& pixel);
  void decide(std::size_t gaussian, bool object);
  enum class Pin { kAll, kSaidAlready };
  void pin(const LeafView& view, std::span<const std::uint32_t> pixels, bool object, Pin which = Pin::kAll);
  void insist(const LeafView& view, std::size_t pixel, bool object);
  void label();

  const PartHierarchy& parts_;
  SelectionModel model_;
  int choice_;
  SelectedParts selected_;
  struct Offers {
    std::vector<std::vector<std::uint8_t>> meant;  // leaves of each meaning
    std::vector<Mask> masks;                       // mask of each meaning in the first click's view
  };
  std::shared_ptr<const Offers> offers_;
  struct OfferedSizes {
    std::size_t count = 0, size = 0, likeliest = 0;
    std::shared_ptr<const std::vector<Mask>> masks{};  // null: there are no sizes
  };
  OfferedSizes sizes_;
  std::vector<std::uint8_t> labels_;
  std::vector<std::int8_t> said_;
  std::vector<std::uint8_t> by_colour_;  // 1 where said_ is so by colour alone
  bool any_ = false;
  std::size_t choice_taken_ = 0;
  bool spot_alone_ = false;
  float certainty_ = 1;
};

}  // namespace splatcut
