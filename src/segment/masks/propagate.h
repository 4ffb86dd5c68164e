// The table of propagators: how the mask of a view is found from what is known so far. Settings, their help
// and the pipeline follow from it. A propagator is one file in src/segment/masks/propagators that defines its
// row, and one line here.
//
// Same result on any number of threads.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "scene/camera/camera.h"

// In the order of lists.
// clang-format off
#define SPLATCUT_PROPAGATORS(row) \
  row(kLift)                      \
  row(kWarp)                      \
  row(kFlow)
// clang-format on

namespace splatcut {

// A view whose mask is known.
struct SeenView {
  Camera camera;
  Image<Rgb8> picture;
  Image<float> depth;  // camera z, 0 where nothing is
  Mask mask;
};

// A view whose mask is wanted.
struct OpenView {
  const Camera& camera;
  const Image<Rgb8>& picture;      // of a propagator that is of pictures; this and the rest are of one size
  const Image<float>& depth;       // the same
  std::span<const SeenView> seen;  // the same, never empty then
  std::function<Mask()> rendered_labels;  // the 3D cut so far, rendered into the view
};

// One row. A value that is copied freely; rows are equal where their names are.
struct Propagator {
  const char* name = "";        // in settings and reports: "dis"
  const char* sentence = "";    // "masks through depth"
  const char* stage = "masks";  // that its time is booked on
  bool of_pictures = false;     // works in two dimensions
  Mask (*mask)(const OpenView& view) = nullptr;

  friend bool operator==(const Propagator& a, const Propagator& b) {
    return std::string_view(a.name) == b.name;
  }

#define SPLATCUT_DECLARE_ROW(row) static const Propagator row;
  SPLATCUT_PROPAGATORS(SPLATCUT_DECLARE_ROW)
#undef SPLATCUT_DECLARE_ROW
};

std::vector<Propagator> propagators();

// The seen view whose camera stands nearest.
const SeenView& nearest(const OpenView& view);

// Each pixel of `to` is looked up in `from` where it shows the same point: depths must agree within
// `tolerance` (relative). What `from` does not show is not object. to_depth: size of `to`.
Mask warped_by_depth(const SeenView& from, const Camera& to, const Image<float>& to_depth,
                     float tolerance = 0.05f);

// Each pixel of `to_picture` (same size as from's) takes the mask where the flow says it came from.
Mask warped_by_flow(const SeenView& from, const Image<Rgb8>& to_picture);

}  // namespace splatcut
