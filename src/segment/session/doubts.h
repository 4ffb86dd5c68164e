// What a person should know before trusting a cutout.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "segment/session/cut_result.h"
#include "segment/session/cut_settings.h"

namespace splatcut {

// True if what was said first may well mean something else: its certainty is below 0.85. docs/study.md has
// how often such answers fail.
bool unsure(const CutResult& result);

// A sentence each, none where nothing is in doubt: unsure(); the last click found no part to change and
// changed the spot around it alone; the object is small in the first view and in those clicked later, or runs
// out of them; masks were left out because they disagree with the others; so many masks that count
// disagree with the cutout that no majority was left.
std::vector<std::string> doubts(const CutResult& result,
                                double view_agreement = CutSettings{}.view_agreement);

// Those that clicks and views raise, the size of the first click apart.
std::vector<std::string> doubts_of(const CutResult& result,
                                   double view_agreement = CutSettings{}.view_agreement);

inline constexpr const char* kRunsOut =
    "the object runs out of the first view: step back and look at all of it";

// Whether a picture shows all of the object that the mask marks in it: it hardly meets the frame.
bool shows_whole(const Mask& mask);

// Those that the views raise.
std::vector<std::string> doubts_of_views(std::span<const ViewReport> views,
                                         double view_agreement = CutSettings{}.view_agreement);

}  // namespace splatcut
