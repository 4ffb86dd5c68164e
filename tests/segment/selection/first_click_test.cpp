// What a first click means: by hand on four stripes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "four_stripes.h"
#include "segment/masks/mask_tools.h"
#include "segment/selection/first_meanings.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("selection: one size smaller and larger, beyond the last there is none") {
  for (const auto& [steps, expected] :
       std::map<int, Labels>{{-1, {1, 0, 0, 0}}, {-9, {1, 0, 0, 0}}, {1, {1, 1, 1, 1}}, {9, {1, 1, 1, 1}}})
    CHECK(selected({sized(object(5), steps)}) == expected);
  const PartHierarchy parts = four_leaves();
  ClickSelection selection(parts, borders_alone());
  selection.apply(stripes(parts), sized(object(5), 9));
  CHECK(selection.sizes() == 3);
  CHECK(selection.size() == 2);
}

TEST_CASE("selection: what is likely enough and shows something else is offered, and can be chosen") {
  // Costs by hand: .09 ln(border / size) is -.65 for the pair, -.06 for all four, 0 for the leaf.
  SelectionModel unsure = borders_alone();
  weight(&unsure.first, Term::kCut) = 0.09f;
  const PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  const std::vector<Labels> meant = {{1, 1, 0, 0}, {1, 1, 1, 1}, {1, 0, 0, 0}};
  for (const int choice : {0, 1, 2, 9}) {
    CAPTURE(choice);
    ClickSelection selection(parts, unsure, choice);
    CHECK(selection.meanings().empty());
    selection.apply(view, object(5));
    const std::size_t taken = std::min<std::size_t>(static_cast<std::size_t>(choice), 2);
    REQUIRE(selection.meanings().size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(iou(selection.meanings()[i], shown(view.leaves, view.camera, meant[i])) == 1);
    CHECK(selection.choice() == taken);
    CHECK(selection.labels() == meant[taken]);
    CHECK(selection.sizes() == 3);
    CHECK(selection.likeliest_size() == selection.size());
  }
  ClickSelection smaller(parts, unsure, 1);
  smaller.apply(view, sized(object(5), -1));  // one size below all four
  CHECK(smaller.labels() == meant[0]);
  ClickSelection sure(parts, borders_alone());
  sure.apply(view, object(5));
  CHECK(sure.meanings().size() == 1);
}

TEST_CASE("selection: how alike all is that a click can mean, until another meaning or size is chosen") {
  SelectionModel unsure = borders_alone();
  weight(&unsure.first, Term::kCut) = 0.09f;
  PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  const auto certainty = [&](int step, int choice) {
    ClickSelection selection(parts, unsure, choice);
    CHECK(selection.certainty() == 1);
    selection.apply(view, sized(object(5), step));
    return selection.certainty();
  };
  // The pair is taken: half of all four, twice the leaf. Their costs are as above.
  const double pair = 0.09 * std::log(0.001 / std::sqrt(2.0)), four = 0.09 * std::log(1 / 2.0), leaf = 0;
  const double others = std::exp(pair - four) + std::exp(pair - leaf);
  CHECK(certainty(0, 0) == doctest::Approx((1 + 0.5 * others) / (1 + others)));
  CHECK(certainty(1, 0) == 1);
  CHECK(certainty(0, 1) == 1);
  ClickSelection sure(parts, borders_alone());
  sure.apply(view, object(5));
  CHECK(sure.certainty() > 0.99);
  // Of a box each tree's best part counts: the pair of the first, the leaf of another.
  parts.trees.push_back(parts.trees.front());
  const std::vector<PartMeaning> meanings = {{0, 4, {}, 0}, {0, 6, {}, 0}, {1, 0, {}, 1}};
  const std::vector<float> leaf_px(4, 10);
  const double vote = std::exp(-1.0);
  CHECK(certainty_of(parts, meanings, Labels{1, 1, 0, 0}, leaf_px, true) ==
        doctest::Approx((1 + 0.5 * vote) / (1 + vote)));
  CHECK(certainty_of(parts, meanings, Labels{1, 1, 0, 0}, leaf_px, false) ==
        doctest::Approx((1 + 0.5 + 0.5 * vote) / (2 + vote)));
}

TEST_CASE("selection: a first click's terms of all views, worked out by hand") {
  // The click's view is four stripes of 100 pixels at one depth, each touching the frame. Elsewhere the left
  // pair covers .04 of a picture, free of the frame, with a border of 1.2 sides before something farther.
  PartHierarchy parts = four_leaves();
  LeafView view = stripes(parts);
  bool close_up = false;
  const auto terms_of_pair = [&] {
    const auto found = ClickSelection(parts, borders_alone())
                           .considered(view, {5.5f, 5.5f}, true, {.all_terms = true, .close_up = close_up});
    REQUIRE(found);
    const auto pair = std::ranges::find(found->candidates, 1u, &Candidate::index);
    REQUIRE(pair != found->candidates.end());
    return pair->terms;
  };
  const TermValues here = terms_of_pair();
  CHECK(weight(here, Term::kNoEdge) == doctest::Approx(1));  // ten pairs of pixels, all plain
  CHECK(weight(here, Term::kCropped) == doctest::Approx(1));
  CHECK(weight(here, Term::kFrame) == doctest::Approx(48 / std::sqrt(200.0)));
  CHECK(weight(here, Term::kLarge) == doctest::Approx(std::log(0.5 / 0.35)));
  parts.trees[0].looks.assign(7, {});
  parts.trees[0].looks[4] = {.area = 0.04f, .area_squared = 0.0016f, .side = 0.2f, .border = 1.2f};
  const TermValues all = terms_of_pair();
  const double border_here = 10 / 20.0, side_here = std::sqrt(0.5), frame_here = 48 / 20.0;
  CHECK(weight(all, Term::kNoEdge) == doctest::Approx(border_here / (border_here + 1.2)));
  CHECK(weight(all, Term::kCropped) == doctest::Approx(side_here / (side_here + 0.2)));
  CHECK(weight(all, Term::kFrame) == doctest::Approx(frame_here / (side_here + 0.2)));
  CHECK(weight(all, Term::kLarge) == doctest::Approx(std::log((0.25 + 0.0016) / (0.5 + 0.04) / 0.35)));
  CHECK(weight(all, Term::kSmall) == 0);
  // A close-up counts only where nothing else shows the clicked leaf.
  close_up = true;
  CHECK(terms_of_pair() == all);
  parts.trees[0].looks[0].area = 0.02f;
  const TermValues elsewhere = terms_of_pair();
  CHECK(weight(elsewhere, Term::kNoEdge) == 0);
  CHECK(weight(elsewhere, Term::kCropped) == 0);
  CHECK(weight(elsewhere, Term::kFrame) == 0);
  CHECK(weight(elsewhere, Term::kLarge) == 0);
}

TEST_CASE("selection: how views elsewhere show a part decides what a first click means") {
  SelectionModel model;
  model.first = {};
  weight(&model.first, Term::kNoEdge) = 1;
  PartHierarchy parts = four_leaves();
  const LeafView view = stripes(parts);
  const auto labels = [&] {
    ClickSelection selection(parts, model);
    selection.apply(view, object(5));
    return selection.labels();
  };
  CHECK(labels() == Labels{1, 1, 1, 1});  // no border of it is seen, others have plain ones
  parts.trees[0].looks.assign(7, {});
  parts.trees[0].looks[4] = {.area = 0.04f, .side = 0.2f, .border = 1.2f};
  CHECK(labels() == Labels{1, 1, 0, 0});
}
