// A mask from words: a program of the user's looks at the picture of a view and writes one.
//
// The command is a template:  python3 sam.py --prompt {text} {image} -o {mask}
// Blanks separate its words; '...' and "..." keep them together; a backslash keeps the next character as it
// is (not within '...'). No shell reads it. {image}: a PNG of the view; {text}: the words; {mask}: where the
// program writes its PNG, of the picture's size.
#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "core/job.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct SegmenterOptions {
  std::string text;
  std::string command;  // the template; empty: that of the environment's SPLATCUT_SEGMENTER
};

struct Segmenter {
  std::string text;
  std::vector<std::string> words;  // of the command
};

// Throws Error where there is no command, or where it lacks a placeholder.
Segmenter make_segmenter(const SegmenterOptions& options);

// Throws Error: the program cannot be started, fails, or leaves no mask that can be used. Cancelled: an empty
// mask.
Mask mask_from_text(const Segmenter& segmenter, const GaussianCloud& cloud, const Camera& camera,
                    const Job& job);

}  // namespace splatcut
