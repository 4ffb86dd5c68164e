// Pictures of a cut for the window: a card per view, and outlines of the first click's meanings.
#pragma once

#include "app/picture/cut_run.h"
#include "core/job.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/raster/rasterizer.h"
#include "segment/session/cut_request.h"
#include "segment/session/session.h"

namespace splatcut {

// Share of the mask's border, [0, 1], that runs through a surface: neither depth nor colour changes across
// it. An object that stands on something has some, a half of one has more. drawn: the view with colour and
// median depth, in any size; a mask of few pixels has 0.
double share_through_surface(const RasterOutput& drawn, const Mask& mask);

// Card of a view that shows its mask alone, for the time until pictures are drawn.
ViewCard mask_card(const ViewReport& view, const Rgb8& colour);

// A cut to draw cards of. Refers to all but the labels before.
struct CutShown {
  const CutRequest& request;
  const CutSettings& settings;
  const CutResult& result;
  Rgb8 colour{};   // the object's
  Flags before{};  // labels before the last stroke, which cards show beside the result's; null: they do not
};

// Cards with rasterised views and the mask in the object's colour. Cards of views that do not count are dark.
// What the last stroke took away is red, what it added green. If the cut used no view around the object, a
// few are added for the user to check, also those that the object went from with that stroke. See
// ViewCard::doubt for what is said of them. What counts but shows next to nothing of the object has no card,
// but for the first view. If cancelled, cards are missing.
std::vector<ViewCard> picture_cards(Session& session, const CutShown& cut, const Job& job);

// The picture of a card, three times as wide. cut: as the card was drawn for, but for masks of its views. If
// cancelled, it must not be used.
Image<Rgba8> large_picture(const Session& session, const CutShown& cut, const ViewCard& card, const Job& job);

// The result with other labels, and what its views show of these: for cards of a cutout that a hand changed.
// If cancelled, masks are missing.
CutResult with_labels(const Session& session, CutResult result, const std::vector<std::uint8_t>& labels,
                      const Job& job);

// Orders cards for the panel: a card whose view is near an earlier card's takes that place, and the others
// follow. The first card, which is the user's own view, stays first.
std::vector<ViewCard> in_places_of(const std::vector<ViewCard>& before, std::vector<ViewCard> cards);

// Doubts of the cards before the last stroke that nobody looked at: a side that lost or got something out of
// sight, or where a border ran through a surface, stays in doubt until half of that changed back. labels: of
// now.
void keep_doubts(const std::vector<ViewCard>& before, const std::vector<std::uint8_t>& labels,
                 std::vector<ViewCard>* cards);

// Sides of the same labels that somebody looked at stay looked at.
void keep_looks(const std::vector<ViewCard>& before, std::vector<ViewCard>* cards);

// Whether the camera shows, from the card's side, what the card is in doubt of.
bool looks_at(const Camera& camera, const ViewCard& card, const GaussianCloud& cloud);

// Gaussians that no cut gives the object, as others, hands or its whole keep them: outlines lead around what
// shows them. Null: there are none.
struct KeptFromCuts {
  const Session& session;
  Flags gaussians;
};

// Meanings of the first click, with outlines; null if the result has none yet. If cancelled, they must not be
// used.
std::shared_ptr<const ClickMeanings> meanings_of(const CutRequest& request, const CutResult& result,
                                                 const KeptFromCuts& kept, const Job& job);

// Sizes of the last stroke, with outlines; null if it has none. Cancelled: as above.
std::shared_ptr<const StrokeSizes> sizes_of(const CutRequest& request, const CutResult& result,
                                            const KeptFromCuts& kept, const Job& job);

}  // namespace splatcut
