// Work that is saved and opened again in another window.
#pragma once

#include <memory>

#include "hands.h"

namespace splatcut::testing {

// A window of the same size with the work of this one, which is saved into the folder.
inline std::unique_ptr<HeadlessApp> reopened(Hands& hands, const ScratchFolder& folder) {
  const auto file = folder / "reopened.splatcut.json";
  hands.studio().apply(SaveWork{file});
  REQUIRE(hands.app.settle());
  auto again = std::make_unique<HeadlessApp>(kHandsWidth, kHandsHeight);
  again->open(file);
  REQUIRE(again->settle());
  return again;
}

}  // namespace splatcut::testing
