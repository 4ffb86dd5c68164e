// The panels: each draws itself into the current ImGui window from a const view and asks for what was
// clicked.
#pragma once

#include "app/ui/ui_context.h"

namespace splatcut {

void top_bar(UiContext& ui);
void options_row(UiContext& ui);  // under the bar, what has no room there
void turntable_button(UiContext& ui, const char* label, float width);
void tool_column(UiContext& ui);
void objects_panel(UiContext& ui);
std::string tip_of_lock(const Document& document, const ObjectItem& object);
void cutout_panel(UiContext& ui);
// What runs for the active object, or is in doubt of it; of sides only beside their thumbnails.
bool has_cut_notes(const Studio& studio, bool thumbnails);
void cut_notes(UiContext& ui, bool thumbnails);
// The sides of the active object: as high as they are in that room, 0: there are none; room.y: they are no
// higher. They scroll where they have too little room.
float view_cards_height(const Studio& studio, const ImVec2& room);
void view_cards(UiContext& ui, const ImVec2& room);
void repair_panel(UiContext& ui);
void scene_panel(UiContext& ui);
void files_panel(UiContext& ui);  // what the scene is made of
void history_panel(UiContext& ui);
void status_bar(UiContext& ui);
std::string status_text(const Studio& studio);  // what runs, at its left end

void start_page(UiContext& ui, const UiRect& area);

void help_page(UiContext& ui);
std::string pointer_words();  // what the pointer does, for the page of keys
float keys_width();           // of the keys on that page, beside which it says what they do; points
void settings_page(UiContext& ui);
void export_dialog(UiContext& ui);
// What is exported as it will stand in the file, with handles; a picture in the dialog, of that size.
void export_preview(UiContext& ui, const glm::vec2& size_points);
void turntable_dialog(UiContext& ui);
void quit_dialog(UiContext& ui);
void open_anyway_dialog(UiContext& ui);
void left_work_list(UiContext& ui);  // work that crashes left
void recent_list(UiContext& ui);
void file_dialog(UiContext& ui);  // and what follows from the choice
void replace_dialog(UiContext& ui);
void open_file_dialog(UiContext& ui, FilePurpose purpose);

}  // namespace splatcut
