#include "segment/doubts.h"

#include <fmt/format.h>

#include <algorithm>

namespace splatcut {

std::vector<std::string> doubts(const PipelineReport& report, double view_agreement) {
  std::vector<std::string> sentences;
  if (report.ambiguous)
    sentences.push_back(fmt::format("the first click could mean a part of another size: this is size {} of {}", report.first_size + 1, report.first_sizes));
  const auto left_out = std::ranges::count_if(report.views, &ViewReport::disagreed);
  if (left_out) sentences.push_back(fmt::format("{} of {} masks were left out, they disagree with the others", left_out, report.views.size()));
  const auto used = std::ranges::count_if(report.views, &ViewReport::used);
  const auto against = std::ranges::count_if(report.views, [&](const ViewReport& v) { return v.used && v.confidence < view_agreement; });
  if (used > 1 && against)
    sentences.push_back(fmt::format("{} of {} masks disagree with the cutout: it is not to be trusted, look at the masks", against, used));
  return sentences;
}

}  // namespace splatcut
