// Which program this is: git's tag, or the project's version (cmake/version.cmake).
#pragma once

namespace splatcut {

const char* version();  // "1.2.0"; twelve commits after its tag "1.2.0+12.gabcdef0"

}  // namespace splatcut
