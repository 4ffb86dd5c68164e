#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include "places.h"

namespace splatcut::testing {

std::string project_folder() {
  return SPLATCUT_SOURCE_DIR;
}
std::string build_folder() {
  return SPLATCUT_BINARY_DIR;
}
std::string splatcut_program() {
  return SPLATCUT_PROGRAM;
}
std::string lab_program() {
  return SPLATCUT_LAB_PROGRAM;
}
std::string fault_shim() {
  return SPLATCUT_FAULT_SHIM;
}

}  // namespace splatcut::testing
