// Talking to a terminal: progress on stderr, Ctrl+C as a stop request.
#pragma once

#include <string>

#include "scene/job.h"

namespace splatcut {

// A job with a progress bar on stderr (only where that is a terminal and quiet is false) that Ctrl+C
// cancels. A second Ctrl+C ends the program at once.
Job console_job(bool quiet);

// Says the sentence on stderr; nothing for an empty one.
void warn(const std::string& sentence, bool quiet);

// Ends the bar's line, if one was drawn.
void end_progress();

}  // namespace splatcut
