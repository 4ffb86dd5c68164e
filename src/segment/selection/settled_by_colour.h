// What the trees disagree about after a first click, and where its border runs, settled by colour.
//
// In: what the click is taken to mean, and the likely meanings with their costs. Out: the same set of leaves
// but for those that some trees would add and others would leave out, and those at its border that the
// picture says otherwise of. Parts end at edges of colour in space, and each tree ends them a little
// differently; a foot of the object, or a tuft beside it, is an accident of one tree or of all. The picture
// decides: whether a colour is that of the object or of what is around it, and where its edges are.
//
// - Voters: of each tree the cheapest part that looks much like what is taken, IoU at least 0.6 in the view;
//   its vote is e to the difference of the costs. Parts 400 times less likely than the likeliest do not vote,
//   nor those that look more like another meaning that is offered. s: a leaf's share of the votes.
// - r: of a pixel ln((p + e) / (q + e)), with p and q the share of its colour among the pixels of the object
//   and of the rest around it, in 512 bins of CIE Lab, e 0.001. Each pixel counts by its leaf's share for the
//   one and the other.
// - A group is all leaves that the same trees hold, hidden ones among them: they are decided together, so
//   that no crumbs come. It is object if ln(s / (1 - s)) + mean r > 0: Bayes' rule. A group counts as one
//   observation, as its pixels are alike. s is held between 0.03 and 0.97. What all voters agree on stays,
//   and so do groups of fewer than 3 pixels.
// - The border: within 24 pixels of it each pixel is object or rest by the least sum of ln(s / (1 - s)) + r,
//   s held between 0.1 and 0.9 and 1 or 0 for a group, r between -3 and 3, and of 12 for each step between
//   neighbours that it separates, less where colour or depth has an edge (cut_by_odds()). A leaf of at least
//   3 pixels goes with most of them. Where the frame crops the object (a twentieth of it or more is object)
//   the border stays: what is around the object is hardly seen.
//
// Nothing changes where the view has no colour. Cost: some 6 ms at 450 pixels wide, half of it for the
// border.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segment/selection/leaf_view.h"
#include "segment/selection/part_votes.h"

namespace splatcut {

// Flags per leaf. meanings: parts, the cheapest first. taken: flags per leaf. others: those of meanings that
// are offered before it.
std::vector<std::uint8_t> settled_by_colour(const PartHierarchy& parts, const LeafView& view,
                                            std::span<const PartMeaning> meanings,
                                            std::span<const std::uint8_t> taken,
                                            std::span<const std::vector<std::uint8_t>> others = {});

}  // namespace splatcut
