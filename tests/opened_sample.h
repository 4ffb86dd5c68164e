// The program in a small window with the sample open.
#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

#include "headless_app.h"

namespace splatcut::testing {

inline constexpr int kSmallWidth = 760, kSmallHeight = 420;

inline HeadlessApp& opened(HeadlessApp& app) {
  app.open(kSample);
  REQUIRE(app.settle());
  REQUIRE(app.studio().scene());
  return app;
}

inline std::vector<std::uint8_t> active_labels(HeadlessApp& app) {
  return app.studio().labels(app.studio().document().active);
}

}  // namespace splatcut::testing
