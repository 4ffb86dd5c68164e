// Pictures of what the window shows, for files: a view, or the object turning once.
#pragma once

#include <filesystem>

#include "app/document/export_plan.h"
#include "app/picture/frame_thread.h"

namespace splatcut {

// Draws a view: transparent, with straight alpha and no background, or opaque over the background (RGB in [0,
// 1]). visible: 1 per Gaussian to draw; null: all. If cancelled, the picture is incomplete.
Image<Rgba8> capture(const GaussianCloud& cloud, const Camera& camera, const Flags& visible,
                     const DrawLimits& limits, const glm::vec3& background, bool transparent, const Job& job);

struct TurntableOptions {
  TurntableAs as = TurntableAs::kPictures;
  std::filesystem::path path;  // folder or file to write; what is there is replaced
  float turn_s = 3;            // duration of one turn in an animation or a video, seconds
  glm::vec3 background{0};     // background of a video, which has no transparency
};

// Writes one picture per camera. Returns false if cancelled: nothing is written then. Throws Error if the
// disk is full, or if ffmpeg is missing or fails.
bool save_turntable(const GaussianCloud& cloud, const std::vector<Camera>& cameras, const Flags& visible,
                    const DrawLimits& limits, const TurntableOptions& options, const Job& job);

}  // namespace splatcut
