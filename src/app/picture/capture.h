// Pictures of what the window shows, for files: a view, the object turning once.
#pragma once

#include <filesystem>

#include "app/document/export_plan.h"
#include "app/picture/frame_thread.h"

namespace splatcut {

// With straight alpha and no background, or opaque over the background. visible: null for all.
Image<Rgba8> capture(const GaussianCloud& cloud, const Camera& camera, const Flags& visible,
                     const DrawLimits& limits, const glm::vec3& background, bool transparent, const Job& job);

struct TurntableOptions {
  TurntableAs as = TurntableAs::kPictures;
  std::filesystem::path path;  // of the folder or file; what is there is replaced
  float turn_s = 3;            // of one turn in animation and video
  glm::vec3 background{0};     // of the video, which knows no transparency
};

// One picture per camera. False where it was cancelled: then nothing is written. Throws Error: the disk is
// full, ffmpeg is missing or fails.
bool save_turntable(const GaussianCloud& cloud, const std::vector<Camera>& cameras, const Flags& visible,
                    const DrawLimits& limits, const TurntableOptions& options, const Job& job);

}  // namespace splatcut
