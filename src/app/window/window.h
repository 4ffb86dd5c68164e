// The real window: GLFW, one OpenGL context, the main loop. Throws Error where there is no display.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <stop_token>

#include "app/window/application.h"

namespace splatcut {

struct WindowOptions {
  std::filesystem::path open;                // a scene or a work file; empty: the start page
  std::vector<std::filesystem::path> added;  // scenes in the same window
  std::optional<SpzAxes> spz_axes;
  std::optional<unsigned> lod;    // without it the finest level of detail that the free memory holds
  std::filesystem::path cameras;  // of OpenScene, as the next
  std::string camera;
  RendererChoice renderer = RendererChoice::kAuto;
  float ui_scale = 0;         // 0: the screen's, times the remembered one
  int width = 0, height = 0;  // 0: as it was left
  PreparedCache cache;
  std::ostream* frame_times = nullptr;  // takes a FrameLog
  std::stop_token stop;  // ends the program; work that is not saved is offered at the next start
};

// Runs until the window is closed, or a stop was asked for.
void run_window(const WindowOptions& options);

// Whether a window can open here; if not, why.
std::string why_no_window();

}  // namespace splatcut
