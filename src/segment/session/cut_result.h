// What a cut is: labels, the views that led to them, and what was found out on the way.
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
};

enum class Outcome { kDone, kNothingFound, kCancelled };

struct CutResult {
  Outcome outcome = Outcome::kDone;
  std::string reason;                // for kNothingFound
  std::vector<std::uint8_t> labels;  // per Gaussian of the cloud, 1 = object
  std::vector<std::uint8_t> prior;   // what the parts say, per Gaussian; it counts in every cut; or empty
  std::vector<std::int8_t> said;     // per Gaussian: +1, -1 as strokes themselves decide, 0 open; or empty
  std::size_t sizes = 0, size = 0;   // that the first click can mean, from small to large; the one taken
  std::size_t likeliest_size = 0;    // the one at part_step 0
  std::vector<Mask> meanings;     // of the first click in its view, the likeliest first; see ClickSelection
  std::size_t choice = 0;         // the one taken
  bool spot_alone = false;        // the last stroke changed the spot around it alone: no part fits it
  bool ambiguous = false;         // another size was nearly as likely
  std::vector<ViewReport> views;  // the reference, the others, then stroked views that correct
  std::string why_enough;         // why there are no more views
  CutFigures cut;                 // of the last cut
  std::size_t trimmed = 0;        // Gaussians that left the object after it
  std::vector<StageTime> stages;  // in order, same names added up; what was kept costs and lists nothing
};

// What strokes say of a Gaussian holds, whatever the views made of it.
void obey_strokes(CutResult* result);

// A cut that keeps less than half of what the parts say is no refinement of what was clicked (of an object of
// a few Gaussians the neighbours around it leave nothing): then the parts' labels stand.
void keep_object(CutResult* result);

// How far a cut has come.
enum class CutPhase {
  kFirstMask,  // the reference's mask is known; labels where parts were asked
  kViews,      // labels from the views so far
  kSettled,    // labels from all views; they may yet lose what does not agree, and be trimmed
};

// Called on the running thread; the result is as far as it has come.
using OnSnapshot = std::function<void(CutPhase, const CutResult&)>;

// What was enough: views that count, and their pixels.
struct LookedAt {
  int views = 0;
  std::size_t pixels = 0;
  double pixels_per_view() const { return views ? static_cast<double>(pixels) / views : 0; }
};
LookedAt looked_at(const std::vector<ViewReport>& views);

}  // namespace splatcut
