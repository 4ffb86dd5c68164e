// The result of a cut: labels, the views that led to them, and figures for reports.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/stage_clock.h"
#include "scene/camera/camera.h"
#include "segment/graphcut/cut.h"

namespace splatcut {

struct ViewReport {
  Camera camera;
  Mask mask;
  bool used = false;
  double confidence = 0;   // IoU of the mask and the final labels seen in this view
  std::string reason;      // why it was left out
  bool disagreed = false;  // left out because its mask disagrees with the others
  bool clicked = false;    // strokes stand in it, and it is not the reference
};

enum class Outcome { kDone, kNothingFound, kCancelled };

struct CutResult {
  Outcome outcome = Outcome::kDone;
  std::string reason;                // for kNothingFound
  std::vector<std::uint8_t> labels;  // per Gaussian of the cloud, 1 = object
  std::vector<std::uint8_t> prior;   // what the parts say, per Gaussian; it counts in every cut; or empty
  // Per Gaussian: +1, -1 as strokes themselves decide, or the one mask that is given; 0 open; or empty.
  std::vector<std::int8_t> said;
  std::size_t sizes = 0, size = 0;  // of what the last stroke means, from small to large; the one taken
  std::size_t likeliest_size = 0;   // the one at step 0
  std::vector<Mask> size_masks;     // of each size, in that stroke's view; see ClickSelection
  std::vector<Mask> meanings;       // of the first click in its view, the likeliest first; see ClickSelection
  std::size_t choice = 0;           // the one taken
  bool spot_alone = false;          // the last stroke changed the spot around it alone: no part fits it
  double certainty = 1;             // of what was said first, [0, 1]; see ClickSelection
  std::vector<ViewReport> views;    // the reference, the others, then stroked views that correct
  std::string why_enough;           // why there are no more views
  CutFigures cut;                   // of the last cut
  std::size_t looked_at_gaussians = 0;  // in the neighbourhood that was cut
  std::size_t trimmed = 0;              // Gaussians that left the object after it
  std::vector<StageTime> stages;  // in order, same names added up; what was kept costs and lists nothing
};

// Sets the label of each Gaussian that strokes decided, whatever the views say.
void obey_strokes(CutResult* result);

// Takes the parts' labels instead if the cut keeps less than half of them: it should refine what was clicked,
// but smoothing may take all of an object of a few Gaussians.
void keep_object(CutResult* result);

// How far a cut has come.
enum class CutPhase {
  kParts,      // labels by parts alone; told only where the graph must be built before anything else
  kFirstMask,  // the reference's mask is known; labels where parts were asked
  kViews,      // labels from the views so far
  kSettled,    // labels from all views; they may yet lose what does not agree, and be trimmed
};

// Called on the running thread; the result is as far as it has come.
using OnSnapshot = std::function<void(CutPhase, const CutResult&)>;

// The views that count, and their pixels in all.
struct LookedAt {
  int views = 0;
  std::size_t pixels = 0;
  double pixels_per_view() const { return views ? static_cast<double>(pixels) / views : 0; }
};
LookedAt looked_at(const std::vector<ViewReport>& views);

}  // namespace splatcut
