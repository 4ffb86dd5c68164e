// What a cut is shown with: a card per view, outlines of the click's meanings.
#pragma once

#include "app/studio/cut_run.h"
#include "core/job.h"
#include "scene/cloud/gaussian_cloud.h"
#include "segment/session/cut_request.h"
#include "segment/session/session.h"

namespace splatcut {

// The view with its mask alone, before there is time for pictures.
ViewCard mask_card(const ViewReport& view, const Rgb8& colour);

// Rasterised, with the mask in the object's colour; dark where the view does not count. Where the cut used
// no view around the object, a few are made for the person to check. Cancelled: incomplete.
std::vector<ViewCard> picture_cards(Session& session, const CutRequest& request, const CutSettings& settings,
                                    const CutResult& result, const Rgb8& colour, const Job& job);

// A card that looks nearly as one did before takes its place in the strip, the others come behind; the first,
// the user's own view, stays first.
std::vector<ViewCard> in_places_of(const std::vector<ViewCard>& before, std::vector<ViewCard> cards);

// Null as long as the result has none.
std::shared_ptr<const ClickMeanings> meanings_of(const CutRequest& request, const CutResult& result);

}  // namespace splatcut
