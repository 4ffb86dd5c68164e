#include "segment/session/doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

// Of the object in the frame's pixels; more of it: the picture crops the object.
constexpr double kMuchOfFrame = 0.15;

double share_of_frame(const Mask& mask) {
  std::size_t frame = 0, object = 0;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      if (x > 0 && x + 1 < mask.width() && y > 0 && y + 1 < mask.height()) continue;
      ++frame;
      object += mask.at(x, y) != 0;
    }
  return frame ? static_cast<double>(object) / static_cast<double>(frame) : 0;
}

// The side of a square as large as the object, in the view's width.
double width_of_object(const ViewReport& view) {
  return std::sqrt(static_cast<double>(count(view.mask))) / std::max(1, view.mask.width());
}

// Whether the view that was clicked in first shows the object large enough, and whole. A click from nearer
// makes up for one from afar, and one in a view of the whole object for one that crops it.
void add_doubts_of_first(std::span<const ViewReport> views, std::vector<std::string>* sentences) {
  // Set where cuts of an earlier program failed; how many do today: docs/study.md.
  constexpr double kSmall = 0.08;
  const double across = width_of_object(views.front());
  const bool from_nearer = std::ranges::any_of(views.subspan(1), [](const ViewReport& v) {
    return v.clicked && v.used && width_of_object(v) >= kSmall;
  });
  if (across > 0 && across < kSmall && !from_nearer)
    sentences->push_back(fmt::format(
        "the object is small in the first view, {:.0f} % of its width: come nearer", 100 * across));
  const bool from_farther = std::ranges::any_of(
      views.subspan(1), [](const ViewReport& v) { return v.clicked && v.used && shows_whole(v.mask); });
  if (share_of_frame(views.front().mask) > kMuchOfFrame && !from_farther) sentences->emplace_back(kRunsOut);
}

}  // namespace

bool shows_whole(const Mask& mask) {
  return count(mask) > 0 && share_of_frame(mask) <= kMuchOfFrame;
}

bool unsure(const CutResult& result) {
  constexpr double kSure = 0.85;
  return result.certainty < kSure;
}

std::vector<std::string> doubts(const CutResult& result, double view_agreement) {
  std::vector<std::string> sentences = doubts_of(result, view_agreement);
  if (!unsure(result)) return sentences;
  sentences.insert(sentences.begin(),
                   result.meanings.size() > 1
                       ? fmt::format("what was said first could mean one of {} things: this is {}",
                                     result.meanings.size(), result.choice + 1)
                       : "what was said first could mean a smaller or a larger part");
  return sentences;
}

std::vector<std::string> doubts_of(const CutResult& result, double view_agreement) {
  std::vector<std::string> sentences = doubts_of_views(result.views, view_agreement);
  if (result.spot_alone)
    sentences.insert(sentences.begin(),
                     std::string("the last click changed the spot around it alone") +
                         (result.size + 1 < result.sizes ? "" : ": scribble over all that is meant"));
  return sentences;
}

std::vector<std::string> doubts_of_views(std::span<const ViewReport> views, double view_agreement) {
  std::vector<std::string> sentences;
  if (!views.empty()) add_doubts_of_first(views, &sentences);
  const auto left_out = std::ranges::count_if(views, &ViewReport::disagreed);
  if (left_out)
    sentences.push_back(
        fmt::format("{} of {} masks were left out, they disagree with the others", left_out, views.size()));
  const auto used = std::ranges::count_if(views, &ViewReport::used);
  const auto against = std::ranges::count_if(
      views, [&](const ViewReport& v) { return v.used && v.confidence < view_agreement; });
  if (used > 1 && against)
    sentences.push_back(
        fmt::format("{} of {} masks disagree with the cutout: it is not to be trusted, look at the masks",
                    against, used));
  return sentences;
}

}  // namespace splatcut
