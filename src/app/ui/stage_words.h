// What the window calls the stages of a job, whose own names are for reports and programs.
#pragma once

#include <string>

namespace splatcut {

// In words of who waits for it; a stage without such words keeps its name.
std::string words_of_stage(const std::string& stage);

}  // namespace splatcut
