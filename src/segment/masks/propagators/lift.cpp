// The default, label propagation: the labels of the 3D cut, rendered into the view.
#include "segment/masks/propagate.h"

namespace splatcut {

constinit const Propagator Propagator::kLift = {
    .name = "lift",
    .sentence = "labels of the cut rendered into the next view",
    .stage = "labels in views",
    .mask = [](const OpenView& view) { return view.rendered_labels(); },
};

}  // namespace splatcut
