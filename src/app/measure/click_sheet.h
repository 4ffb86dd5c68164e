// A session of the any-view robot as one picture, to be looked at.
//
// A column a click. Above: the clicked view as the click found it, the click in it (green: object, red: rest,
// with a white rim). Below: the same view after it. Pixels that are right are tinted green, those that are
// missing red, those that are too much blue; where the view's truth is unknown, what is shown is green.
// The session is played again: one cut a click.
#pragma once

#include "app/measure/any_view.h"
#include "core/image.h"

namespace splatcut {

// Views are drawn kSheetViewWidthPx wide. Cancelled: incomplete.
inline constexpr int kSheetViewWidthPx = 280;
Image<Rgb8> click_sheet(const GaussianCloud& cloud, const AnyViewWorld& world, const AnyViewSession& session,
                        const Job& job = {});

}  // namespace splatcut
