// Talking to a terminal: progress on stderr, signals that end a program as stop requests.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/job.h"

namespace splatcut {

// A job with a progress bar on stderr (only where that is a terminal and quiet is false) that Ctrl+C, SIGTERM
// and SIGHUP cancel. A second one ends the program at once. A file that is cut short while it is read
// ends it, too, with a sentence.
Job console_job(bool quiet);

// Throws Error where it was cancelled. command: which has written nothing so far.
void stop_if_cancelled(const Job& job, std::string_view command);

// Says the sentence on stderr; nothing for an empty one.
void warn(const std::string& sentence, bool quiet);

// Ends the bar's line, if one was drawn.
void end_progress();

// Says on stdout what was written; on stderr where that was a pipe or a device, which stdout may be.
void say_written(const std::filesystem::path& file, const std::string& lines);

// Never throws: nobody may be left to read, as after SIGHUP.
void to_stderr(const std::string& text);

}  // namespace splatcut
