// What the rest of a scene loses with an object that leaves it, and what it gets back: so that no ghost of
// the object stays where it stood, and what surrounds it looks as before.
//
// In: scene, labels, those of the object's own views (own_views.h) that it goes by, what carve.h took off the
// object. Sums over those views of the whole scene's drawing, per Gaussian: A of alpha T, M of it inside of
// the object's masks; how far the views agree, sum |2 M_v - A_v| / A. A Gaussian is sure where A > .5 px,
// they agree by more than .9, and its label is what M / A > .5 says.
//   given back  what carve.h took off the object and whose 8 nearest sure ones are mostly the rest's
//   ghosts      of the rest, in the object's box, M / A > .5 or A < .5 px, and most of their 8 nearest sure
//               ones are the object's; but for those that what surrounds the object needs: the rest is drawn
//               with and without the ghosts, e = by how much its squared error against the scene grows by
//               their leaving, per pixel up to 8 px outside of the mask. Where the mean of e over all that a
//               ghost shows is above 2e-6, it stays.
// In a large scene the cloud is the part of it that the views show (shown_part.h): nothing else matters.
// Cost: five drawings of the cloud a view, a k-d tree over the sure ones, and some 60 bytes a Gaussian.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/job.h"
#include "segment/finish/carve.h"
#include "segment/finish/own_views.h"

namespace splatcut {

struct RestChanges {
  std::vector<std::uint32_t> ghosts;  // indices in the cloud, ascending: leave with the object
  GaussianCloud given_back;           // file_row: of the Gaussian that each was or was a part of
};

// object: index in the cloud of each Gaussian that CutOff::of counts. leaving: per Gaussian, not 0 for those
// of all objects that leave the scene together; empty: this one leaves alone. Cancelled: unspecified.
RestChanges forget(const GaussianCloud& cloud, std::span<const std::uint8_t> labels,
                   std::span<const std::uint32_t> object, std::span<const OwnView> views,
                   std::span<const CutOff> cut_off, std::span<const std::uint8_t> leaving, const Job& job);

// What `more` changes beside.
void add(const RestChanges& more, RestChanges* changes);

// The rest: those of the scene with a flag in `shown`, the ghosts not among them, then what was given back.
GaussianCloud rest_of(const GaussianCloud& scene, std::span<const std::uint8_t> shown,
                      const RestChanges& changes);

}  // namespace splatcut
