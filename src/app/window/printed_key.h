// Which key is meant on keyboards that print other signs than an American one.
#pragma once

#include <string_view>

namespace splatcut {

// Code of the key that a user means, as KeyChanged has it. code: as GLFW numbers the key, by the sign that an
// American keyboard prints at its place. printed: what the user's keyboard prints there without Shift, UTF-8;
// empty: that is not known.
//
// Letters, + - = [ ] , and / are taken as printed, wherever they lie. What prints another sign keeps the
// meaning of its place: digits of a French keyboard, letters of a Russian one, brackets of a German one. The
// digits keep it even where they print one of these signs, because their places are the tools.
int key_meant(int code, std::string_view printed);

}  // namespace splatcut
