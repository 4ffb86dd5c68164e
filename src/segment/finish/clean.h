// An object as one keeps it: its Gaussians without what the scene around it had hidden.
//
// Labels say whose each Gaussian is; drawn alone, an object right by its labels still shows skirts of the
// ground, needles, and holes where the wall behind it closed it. This makes a copy of the object's Gaussians,
// drawn alone into its own views (own_views.h), and in it
//   1. lets leave what its own pictures do not show, and cuts what sticks out of them (carve.h)
//   2. makes solid what lets a background through (solid.h)
//   3. fits colours to the scene's own pictures (recolour.h).
// No Gaussian is added; labels and the scene stay as they are. What the rest of the scene loses and gets back
// where it is written without the object: forget.h.
//
// It goes by the views in which the object alone and its labels within the scene agree in .95 of their
// pixels, and by those of the others that agree best, up to 6. Where labels lack a piece, less than a
// twentieth of what is seen of it goes with what lies around that piece.
//
// The guard: where all that makes the object less like its own pictures on black, by more than 1 dB, what was
// cut off was seen, and the object stays as it is.
//
// Constants were chosen on five captures with masks of photographs and held on others: docs/edges.md.
// Same input, same bits, on any number of threads. Cost: one drawing of the scene a view, two of the part of
// it that the views show (shown_part.h), seven of that with the rest, and ten of the object. Cancelled: the
// result is unspecified.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/job.h"
#include "scene/cloud/gaussian_cloud.h"
#include "segment/finish/forget.h"
#include "segment/finish/own_views.h"

namespace splatcut {

struct CleanInput {
  Drawer scene;                          // with blocks, its drawings pass over what they do not show
  std::span<const std::uint8_t> labels;  // per Gaussian, 1 = object
  glm::vec3 up_world{0, -1, 0};
  std::span<const Camera> cameras;             // of the capture, may be empty
  bool rest = false;                           // whether CleanObject::rest is wanted
  std::span<const std::uint8_t> leaving = {};  // see forget.h
};

struct CleanReport {
  bool cleaned = false;
  std::string why_not;        // a sentence without a full stop; empty: it is cleaned
  int views = 0, agreed = 0;  // that show the object; those of them that agree
  int used = 0;               // those that it is cleaned by
  std::size_t left = 0, split = 0, made_solid = 0, recoloured = 0;  // Gaussians
};

// Index that no Gaussian of a scene has.
inline constexpr std::uint32_t kNoGaussian = 0xffffffff;

struct CleanObject {
  GaussianCloud cloud;                  // the object's Gaussians, those that left not among them
  std::vector<std::uint32_t> gaussian;  // per Gaussian of `cloud`, its index in the scene, ascending
  RestChanges rest;                     // what else leaves the scene with the object, or stays in it; none
                                        // where it is not cleaned
  CleanReport report;
};

// Where it is not cleaned, all labelled Gaussians as they are.
CleanObject clean_object(const CleanInput& input, const OwnViewOptions& options = {}, const Job& job = {});

}  // namespace splatcut
