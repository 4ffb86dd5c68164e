#include "segment/doubts.h"

#include <fmt/format.h>

#include <algorithm>

namespace splatcut {

std::vector<std::string> doubts(const PipelineReport& report, double view_agreement) {
  std::vector<std::string> sentences = doubts_of_views(report.views, view_agreement);
  if (report.ambiguous)
    sentences.insert(sentences.begin(),
                     fmt::format("the first click could mean a part of another size: this is size {} of {}", report.first_size + 1, report.first_sizes));
  return sentences;
}

std::vector<std::string> doubts_of_views(std::span<const ViewReport> views, double view_agreement) {
  std::vector<std::string> sentences;
  const auto left_out = std::ranges::count_if(views, &ViewReport::disagreed);
  if (left_out) sentences.push_back(fmt::format("{} of {} masks were left out, they disagree with the others", left_out, views.size()));
  const auto used = std::ranges::count_if(views, &ViewReport::used);
  const auto against = std::ranges::count_if(views, [&](const ViewReport& v) { return v.used && v.confidence < view_agreement; });
  if (used > 1 && against)
    sentences.push_back(fmt::format("{} of {} masks disagree with the cutout: it is not to be trusted, look at the masks", against, used));
  return sentences;
}

}  // namespace splatcut
