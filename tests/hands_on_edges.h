// What tests of exports and of clean edges do with the object that is active.
#pragma once

#include "hands.h"
#include "segment/finish/clean.h"

namespace splatcut::testing {

// The apple with the table and the shadows that touch it.
inline void take_what_touches_it(Hands& hands) {
  hands.studio().apply(EditSelection{SelectionEdit::kGrow});
  REQUIRE(hands.app.settle());
}

inline bool changed(const CleanReport& report) {
  return report.cleaned && report.left + report.split + report.made_solid + report.recoloured > 0;
}

// The object that is active, as the command line cleans its edges.
inline CleanObject cleaned_without_window(Hands& hands) {
  const OpenedScene& scene = *hands.studio().scene();
  const auto labels = hands.studio().labels(hands.studio().document().active);
  return clean_object({*scene.cloud, labels, hands.studio().document().up_world, scene.views().cameras});
}

}  // namespace splatcut::testing
