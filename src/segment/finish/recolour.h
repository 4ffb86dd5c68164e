// Fits the constant colour of an object's Gaussians so that the object alone looks as it did in the scene,
// where neighbours, now gone, had shone through and over it.
//
// Per round, view and Gaussian, over pixels more than 1 px inside of the view's mask: N = sum of alpha T r,
// D = sum of alpha T max(alpha, .05), r = the scene's picture - the object's. Then, per channel,
//   mean = sum N / sum D,   var = variance of N / D over the views, weighted by D,   k = (sum D)^2 / sum D^2
//   step = sum N / (sum D + 4) clamp(1 - var / ((k - 1) mean^2), 0, 1),   within +-.15 of a colour
// The shrinkage keeps what the views do not agree upon, highlights above all, from being baked in; Gaussians
// seen in one view stay. Source: normal equations of a linear picture, diagonal; James, Stein, Estimation
// with quadratic loss, 1961, for the shrinkage. Cost: two drawings of the object a view and round.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/job.h"
#include "segment/finish/own_views.h"

namespace splatcut {

// Returns how many Gaussians changed by more than half an 8-bit step.
std::size_t recolour(std::span<const OwnView> views, const std::vector<std::uint8_t>& kept,
                     GaussianCloud* object, const Job& job);

}  // namespace splatcut
