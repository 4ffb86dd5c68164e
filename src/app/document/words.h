// Numbers as text for people, written one way everywhere.
#pragma once

#include <cstddef>
#include <string>

namespace splatcut {

std::string grouped(std::size_t n);         // "92,440"
std::string gaussians_text(std::size_t n);  // "92,440 Gaussians", "1 Gaussian"

// A length of the scene with three figures: "0.0235", "12.4", "1,250". Scene units.
std::string length_text(float length);

}  // namespace splatcut
