// Where the project, the built programs and what tests write are. The build says so to test_main.cpp alone,
// so that no other object depends on the folder that the project lies in (ccache finds it again for another).
#pragma once

#include <string>

namespace splatcut::testing {

std::string project_folder();
std::string build_folder();  // of the tests
std::string splatcut_program();
std::string lab_program();
std::string fault_shim();  // a library to preload, empty where none is built

}  // namespace splatcut::testing
