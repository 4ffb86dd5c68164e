#include "app/ui/theme.h"

#include <cmath>

extern "C" {
extern const char splatcut_roboto_regular[], splatcut_roboto_regular_end[];
extern const char splatcut_roboto_medium[], splatcut_roboto_medium_end[];
extern const char splatcut_font_awesome[], splatcut_font_awesome_end[];
}

namespace splatcut {

namespace {

constexpr float kBodyPoints = 15, kTitlePoints = 23, kIconPoints = 15;

// Latin with that of Vietnamese, accents that stand by themselves (names from a Mac have them), Greek and
// Cyrillic for file names; dashes, dots and quotes.
constexpr ImWchar kTextRange[] = {0x20, 0x24f, 0x300, 0x52f, 0x1e00, 0x1eff, 0x2010, 0x203a, 0};
constexpr ImWchar kIconRange[] = {0xf000, 0xf2e0, 0};

ImFont* add_font(const char* begin, const char* end, float pixels, const ImWchar* range,
                 ImFontConfig config = {}) {
  config.FontDataOwnedByAtlas = false;
  config.OversampleH = 2;
  return ImGui::GetIO().Fonts->AddFontFromMemoryTTF(const_cast<char*>(begin), static_cast<int>(end - begin),
                                                    pixels, &config, range);
}

ImVec4 rgb(unsigned hex) {
  const auto channel = [hex](int shift) { return static_cast<float>((hex >> shift) & 255u) / 255.0f; };
  return {channel(16), channel(8), channel(0), 1};
}

const Palette kDark = {rgb(0x24272d), rgb(0x1a1c20), rgb(0x30343b), rgb(0x3c4149),
                       rgb(0x191b1f), rgb(0xe8eaed), rgb(0x9fa6b0), rgb(0x4f9df0),
                       rgb(0x0c1420), rgb(0x5cc98a), rgb(0xf2b544), rgb(0xf2706a)};
const Palette kLight = {rgb(0xf2f3f5), rgb(0xdfe2e7), rgb(0xffffff), rgb(0xc6cbd3),
                        rgb(0xffffff), rgb(0x1c2127), rgb(0x5c6570), rgb(0x1f6fd0),
                        rgb(0xffffff), rgb(0x1d7f4a), rgb(0x9a5f00), rgb(0xc02f2a)};

}  // namespace

ImU32 packed(const ImVec4& colour, float alpha) {
  return ImGui::ColorConvertFloat4ToU32({colour.x, colour.y, colour.z, colour.w * alpha});
}

ImU32 ink_on(const ImVec4& ground) {
  // The relative luminance of WCAG 2, gamma taken as 2.2; black and white contrast alike on .18.
  const auto linear = [](float c) { return std::pow(c, 2.2f); };
  const float light = 0.2126f * linear(ground.x) + 0.7152f * linear(ground.y) + 0.0722f * linear(ground.z);
  return light > 0.18f ? 0xff000000u : 0xffffffffu;
}

void load_fonts(Theme* theme, float pixels_per_point) {
  theme->pixels_per_point = pixels_per_point;
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  io.FontGlobalScale = 1 / pixels_per_point;
  const float body = std::round(kBodyPoints * pixels_per_point);
  theme->body = add_font(splatcut_roboto_regular, splatcut_roboto_regular_end, body, kTextRange);
  ImFontConfig icons;
  icons.MergeMode = true;
  icons.GlyphMinAdvanceX = std::round(17 * pixels_per_point);
  add_font(splatcut_font_awesome, splatcut_font_awesome_end, std::round(kIconPoints * pixels_per_point),
           kIconRange, icons);
  theme->strong = add_font(splatcut_roboto_medium, splatcut_roboto_medium_end, body, kTextRange);
  theme->title = add_font(splatcut_roboto_medium, splatcut_roboto_medium_end,
                          std::round(kTitlePoints * pixels_per_point), kTextRange);
}

void apply_theme(Theme* theme, bool dark) {
  theme->dark = dark;
  theme->colour = dark ? kDark : kLight;
  const Palette& p = theme->colour;
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  dark ? ImGui::StyleColorsDark(&style) : ImGui::StyleColorsLight(&style);
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 5};
  style.ItemSpacing = {7, 7};
  style.ItemInnerSpacing = {6, 5};
  style.WindowRounding = style.PopupRounding = 7;
  style.FrameRounding = style.GrabRounding = 5;
  style.ScrollbarRounding = 6;
  style.ScrollbarSize = 11;
  style.WindowBorderSize = style.PopupBorderSize = 1;
  style.FrameBorderSize = dark ? 0.0f : 1.0f;
  style.DisabledAlpha = 0.4f;
  const auto faded = [](ImVec4 c, float alpha) {
    c.w = alpha;
    return c;
  };
  const auto set = [&style](ImGuiCol which, const ImVec4& c) { style.Colors[which] = c; };
  set(ImGuiCol_Text, p.text);
  set(ImGuiCol_TextDisabled, p.muted);
  set(ImGuiCol_WindowBg, p.panel);
  set(ImGuiCol_ChildBg, {0, 0, 0, 0});
  set(ImGuiCol_PopupBg, p.panel);
  set(ImGuiCol_Border, p.line);
  set(ImGuiCol_FrameBg, p.field);
  set(ImGuiCol_FrameBgHovered, p.panel_high);
  set(ImGuiCol_FrameBgActive, p.panel_high);
  set(ImGuiCol_Button, p.panel_high);
  set(ImGuiCol_ButtonHovered, faded(p.accent, 0.35f));
  set(ImGuiCol_ButtonActive, faded(p.accent, 0.6f));
  set(ImGuiCol_Header, faded(p.accent, 0.28f));
  set(ImGuiCol_HeaderHovered, faded(p.accent, 0.2f));
  set(ImGuiCol_HeaderActive, faded(p.accent, 0.4f));
  set(ImGuiCol_CheckMark, p.accent);
  set(ImGuiCol_SliderGrab, faded(p.accent, 0.55f));
  set(ImGuiCol_SliderGrabActive, p.accent);
  set(ImGuiCol_Separator, p.line);
  set(ImGuiCol_ScrollbarBg, {0, 0, 0, 0});
  set(ImGuiCol_ScrollbarGrab, p.line);
  set(ImGuiCol_PlotHistogram, p.accent);
  set(ImGuiCol_TitleBg, p.panel_low);
  set(ImGuiCol_TitleBgActive, p.panel_low);
  set(ImGuiCol_ModalWindowDimBg, {0, 0, 0, 0.45f});
}

}  // namespace splatcut
