#include "app/ui/stage_words.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace splatcut {

namespace {

struct StageWords {
  std::string_view stage, words;
};

// Short, as they stand in the panel's progress bar.
constexpr std::array kStageWords = {StageWords{"parts", "finding the parts around it"},
                                    StageWords{"what strokes hit", "finding what is clicked"},
                                    StageWords{"earlier strokes", "repeating earlier strokes"},
                                    StageWords{"first mask", "looking for what is meant"},
                                    StageWords{"graph", "finding neighbours"},
                                    StageWords{"neighbours", "finding neighbours"},
                                    StageWords{"view", "looking at it"},
                                    StageWords{"views", "looking from other sides"},
                                    StageWords{"masks", "finding it in other sides"},
                                    StageWords{"labels in views", "drawing it from other sides"},
                                    StageWords{"likelihood", "weighing what was seen"},
                                    StageWords{"cut", "settling the border"},
                                    StageWords{"trim", "dropping floaters"},
                                    StageWords{"cache", "looking for kept parts"},
                                    StageWords{"pictures of the views", "drawing thumbnails"},
                                    StageWords{"own views", "looking at the edges"},
                                    StageWords{"clean edges", "cleaning the edges"},
                                    StageWords{"ghosts", "looking for faint remains"},
                                    StageWords{"the rest", "looking at the rest"},
                                    StageWords{"the hole", "filling the hole"},
                                    StageWords{"ground that nobody saw", "looking for unseen ground"},
                                    StageWords{"who saw it", "looking who saw it"},
                                    StageWords{"carrying labels", "carrying the objects over"}};

}  // namespace

std::string words_of_stage(const std::string& stage) {
  const auto found = std::ranges::find(kStageWords, std::string_view(stage), &StageWords::stage);
  return found == kStageWords.end() ? stage : std::string(found->words);
}

}  // namespace splatcut
