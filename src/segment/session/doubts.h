// What a person should know before trusting a cutout.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "segment/session/cut_result.h"
#include "segment/session/cut_settings.h"

namespace splatcut {

// A sentence each, none where nothing is in doubt: the first click means something else, or another size,
// nearly as likely; the last click found no part to change and changed the spot around it alone; the object
// is small in the first view and in those clicked later, or runs out of the first; masks were left out
// because they disagree with the others; so many masks that count disagree with the cutout that no majority
// was left.
std::vector<std::string> doubts(const CutResult& result,
                                double view_agreement = CutSettings{}.view_agreement);

// Those that clicks and views raise, the size of the first click apart.
std::vector<std::string> doubts_of(const CutResult& result,
                                   double view_agreement = CutSettings{}.view_agreement);

// Those that the views raise.
std::vector<std::string> doubts_of_views(std::span<const ViewReport> views,
                                         double view_agreement = CutSettings{}.view_agreement);

}  // namespace splatcut
