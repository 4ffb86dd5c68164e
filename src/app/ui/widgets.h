// Small pieces that all panels use.
#pragma once

#include <string>

#include "app/document/words.h"
#include "app/ui/ui_context.h"

namespace splatcut {

// The view's switch, for what is written of an object; greyed with `reason` unless that is empty.
// reason: why nothing is cleaned, whatever is set; it stands beside the box, which has no tick then.
void clean_edges_choice(UiContext& ui, const std::string& reason = {});
// The same for the hole that the object leaves in what is written of the rest.
void fill_hole_choice(UiContext& ui);
// How many sides of the objects that are written are in doubt, as a sentence; empty: none is.
std::string sides_in_doubt(const Studio& studio, ExportWhat what);
// A dialog with such switches opens, unless it comes back; and ends. Not kept, they are as they were before.
void remember_finish(UiContext& ui);
void leave_finish(UiContext& ui, bool kept);

// A button for an action of the key table: greyed with its reason where it is not allowed, its keys in the
// tooltip. label: what it shows, an icon or text. on: drawn as switched on. width 0: as wide as its label.
void action_button(UiContext& ui, Action action, const char* label, bool on = false, float width = 0);

// A button that is greyed with `reason` unless that is empty. True when pressed.
bool button(UiContext& ui, const char* label, const std::string& tip, const std::string& reason = {},
            bool on = false, float width = 0);

// A button without a tooltip. width -1: as wide as there is room.
bool plain_button(UiContext& ui, const char* label, float width = 0);

void come_nearer_button(UiContext& ui, float width = 0);

// What a dialog that is wanted does while another one is shown: it waits for that one's end, or it takes its
// place. ImGui would let the later one replace the earlier one each frame, and show neither.
enum class Turn { kAfterOthers, kFirst };

// Begins a dialog in the middle of the window; it opens once it is wanted and has its turn. Returns true
// while the dialog is shown; the caller ends it with EndPopup() then.
bool begin_dialog(const char* id, bool wanted, const ImVec2& size, Turn turn = Turn::kAfterOthers);

bool enter_pressed();   // a dialog's default answer, where nothing else takes the key
bool escape_pressed();  // leaves a dialog; a key that closed the one before says nothing to this one

// Enter and Esc are for a field of the dialog that is being typed in; those of the field with this label go
// on to the dialog. Asked before the fields are made.
bool typing_beside(const char* label);

inline constexpr ImGuiSliderFlags kTypedLength =
    ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat;

// A slider whose number stands beside it, by its user; typed into, it shows what is typed.
bool slider_without_text(const char* id, float* value, float least, float most, const char* format,
                         ImGuiSliderFlags flags);

// The same with its number beside it. widest: the longest number that comes, which is left room.
bool numbered_slider(UiContext& ui, const char* id, float* value, float least, float most, const char* format,
                     ImGuiSliderFlags flags, const char* widest);

bool tolerance_slider(UiContext& ui, float* share);  // of colours, in percent; true where it changed

// Equal buttons in a row, or each in a row of its own where some label does not fit.
class ButtonRow {
 public:
  explicit ButtonRow(std::initializer_list<const char*> labels);
  float next();  // width of the next button, which comes into its place

 private:
  float width_ = 0;
  bool beside_ = true, begun_ = false;
};
void same_line_if_fits(const char* label, float spacing);  // for a button with the label

void progress_bar(UiContext& ui, double fraction, float width);  // thin, in the middle of a line

struct TipPicture {
  ImTextureID texture = {};
  ImVec2 size{0, 0};  // points; 0: none
};
// Of the current window's items: they lie beside it, where else one would cover the item below.
void tooltips_beside_window();
// Of the last item. message: it stays above that. picture: it stands over the text.
void tooltip(const std::string& text, const UiRect& message = {}, const TipPicture& picture = {});
// At the pointer, inside of a part of the screen.
void tooltip_within(const UiRect& area, const std::string& text);
void muted_text(UiContext& ui, const std::string& text);
void wrapped_muted(UiContext& ui, const std::string& text);
void wrapped_warning(UiContext& ui, const std::string& text);
bool section(UiContext& ui, const char* title, bool open = true);

// The axes that the scene's file has, which are what people know: those of a .spz or .glb are not ours.
AxisSigns axes_of_file(const Studio& studio);

std::string tip_of(Action action);                        // "Undo (Ctrl+Z)"
std::string tip_of(const Studio& studio, Action action);  // the same, with the name of the object it is about
ImVec4 colour_of(const Rgb8& c);

}  // namespace splatcut
