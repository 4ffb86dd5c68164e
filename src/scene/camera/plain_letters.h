// Names of files in one way: a letter with marks is one character, or several as macOS writes them.
#pragma once

#include <string>
#include <string_view>

namespace splatcut {

// UTF-8 with Latin, Vietnamese and Cyrillic letters without their marks, kana without marks of voice, and
// syllables of Hangul as their parts. Two writings of one name become alike; so may names that differ in
// marks alone. Bytes that are no UTF-8 stay.
std::string without_accents(std::string_view name);

}  // namespace splatcut
