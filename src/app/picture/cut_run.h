// One cut as the window knows it: its times, views and doubts, the meanings of its first click and the sizes
// of its last.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/document/document.h"
#include "app/document/doubtful_side.h"
#include "core/image.h"
#include "core/stage_clock.h"
#include "segment/session/cut_result.h"

namespace splatcut {

// A view that the cut used, as the thumbnail strip shows it.
struct ViewCard {
  Camera camera;
  bool used = true;
  double confidence = 0;
  std::string reason;  // reason why the view does not count; empty: it counts
  std::shared_ptr<const Image<Rgba8>> picture;
  std::shared_ptr<const Image<Rgba8>> large{};  // the same, three times as wide; null: nobody asked for it
  bool only_to_look = false;                    // true: the view had no influence on the cut
  std::string doubt;             // why the cutout is in doubt there, after "In doubt: "; empty: it is not
  bool doubt_of_stroke = false;  // true: it is of what the last stroke changed
  // What it is of, also since earlier strokes, strokes' and borders apart; empty: not known.
  OpenDoubts open{};
  bool looked_at = false;    // true: somebody looked at it, so it ends with the next stroke
  std::string legend;        // what its marks of that change mean, a line of its own; empty: it has none
  std::uint64_t serial = 0;  // number that changes with the picture
};

using Borders = std::vector<std::vector<glm::vec2>>;  // closed lines

// The meanings of an object's first click, once a cut has found them.
struct ClickMeanings {
  std::string key;                // key of that click, see key_of_first_stroke()
  Camera camera;                  // camera of the click
  std::vector<Borders> outlines;  // borders of each meaning, in the camera's pixels
};

// The sizes of what an object's last stroke means, once a cut has found them, from small to large.
struct StrokeSizes {
  std::string key;                      // key of the strokes, see key_of_last_stroke()
  std::size_t size = 0, likeliest = 0;  // size taken now, and that at step 0
  Camera camera;                        // camera of the stroke
  std::vector<Borders> outlines;        // borders of each size, in the camera's pixels: at least one
  std::size_t count() const { return outlines.size(); }
};

// A finished cut, or the running one.
struct CutRun {
  bool running = false;
  std::string key;                          // cut_key() of its inputs
  std::shared_ptr<const CutResult> result;  // result; null until the cut is done
  std::vector<StageTime> stages;            // times of the stages so far
  std::vector<ViewCard> views;
  bool views_of_before = false;  // true: `views` are those of the object's last cut, until new ones are drawn
  bool views_drawn = false;      // true: `views` are the pictures of this cut's result, all of them
  Flags preview;                 // labels so far; null once the cut is done
  double first_mask_ms = 0, total_ms = 0;
  std::shared_ptr<const ClickMeanings> meanings;  // meanings of the first click; null: not known yet
  std::shared_ptr<const StrokeSizes> sizes;       // sizes of the last stroke; null: not known, or it has none
  bool changed_nothing = false;  // true: the last stroke left the labels as they were, which was said
  // Doubts about the result, one sentence each; once pictures of its sides are there, one on those.
  std::vector<std::string> doubts;
  Flags views_labels;  // labels that `views` and `doubts` are about; null: those of the result
  Flags views_before;  // labels before the last stroke, which `views` show beside them; null: they do not
  std::uint64_t views_at = 0;  // History::serial() at which `views` were found to be what they should
  // Likelihood per Gaussian, [0, 1]; null until it is asked for.
  std::shared_ptr<const std::vector<float>> likelihood;
  bool likelihood_failed = false;  // true: the likelihood is not asked for again
};

}  // namespace splatcut
