// Fonts, colours and measures of the interface. Lengths are logical points.
#pragma once

#include <imgui.h>

#include <glm/glm.hpp>

namespace splatcut {

struct Palette {
  ImVec4 panel, panel_low, panel_high, line, field, text, muted, accent, on_accent, good, warn, bad;
};

struct Theme {
  bool dark = true;
  float pixels_per_point = 1;
  ImFont* body = nullptr;
  ImFont* strong = nullptr;
  ImFont* title = nullptr;
  Palette colour;
};

// Loads the fonts for a scale into the current ImGui context's atlas; they look sharp on HiDPI screens.
void load_fonts(Theme* theme, float pixels_per_point);

// Colours and spacing of the current ImGui context.
void apply_theme(Theme* theme, bool dark);

// Black or white, whichever is read better on that colour.
ImU32 ink_on(const ImVec4& ground);

ImU32 packed(const ImVec4& colour, float alpha = 1);

inline ImVec2 vec(const glm::vec2& v) {
  return {v.x, v.y};
}

// x red, y green, z blue, wherever axes are drawn.
inline constexpr ImU32 kAxisInks[] = {IM_COL32(235, 85, 80, 255), IM_COL32(110, 195, 80, 255),
                                      IM_COL32(80, 140, 245, 255)};

// Symbols of the icon font.
namespace icon {
inline constexpr const char *kOpen = "\xef\x81\xbc", *kSave = "\xef\x83\x87", *kExport = "\xef\x82\x8e",
                            *kUndo = "\xef\x83\xa2", *kRedo = "\xef\x80\x9e", *kCamera = "\xef\x80\xb0",
                            *kGear = "\xef\x80\x93", *kHelp = "\xef\x84\xa8", *kEye = "\xef\x81\xae",
                            *kEyeOff = "\xef\x81\xb0", *kLock = "\xef\x80\xa3", *kUnlock = "\xef\x82\x9c",
                            *kPlus = "\xef\x81\xa7", *kMore = "\xef\x85\x81", *kTrash = "\xef\x87\xb8",
                            *kCheck = "\xef\x80\x8c", *kClose = "\xef\x80\x8d", *kInfo = "\xef\x81\x9a",
                            *kWarning = "\xef\x81\xb1", *kFolder = "\xef\x81\xbb", *kFile = "\xef\x85\x9b",
                            *kRefresh = "\xef\x80\xa1", *kFilm = "\xef\x80\x88", *kTint = "\xef\x81\x83",
                            *kHeat = "\xef\x81\xad", *kColumns = "\xef\x83\x9b", *kUp = "\xef\x81\xa2",
                            *kDown = "\xef\x83\x97", *kOutline = "\xef\x84\x8c";
}

}  // namespace splatcut
