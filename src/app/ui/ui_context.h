// What every panel is given: a const view of the application, a place for what it asks for, and its own
// state.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/document/export_choice.h"
#include "app/picture/ground_grid.h"
#include "app/picture/splat_rings.h"
#include "app/studio/studio.h"
#include "app/ui/grips.h"
#include "app/ui/theme.h"
#include "app/ui/ui_renderer.h"
#include "app/work/file_browser.h"
#include "app/work/native_dialog.h"

namespace splatcut {

// Panels collect requests; the application performs them after the frame.
struct Requests {
  std::vector<Action> actions;
  std::vector<Command> commands;

  void operator()(Action action) { actions.push_back(action); }
  void operator()(Command command) { commands.push_back(std::move(command)); }
};

// What the export dialog shows of where things will stand in the file.
struct ExportPreview {
  std::string key;  // what frame and sample were made for
  ExportFrame frame;
  GaussianCloud sample;   // of the Gaussians that are written, where they stand in the scene
  Image<Rgba8> picture;   // of the sample, drawn by picture_camera
  Camera picture_camera;  // in the scene, of as many pixels as the preview has points
  std::uint64_t picture_serial = 0;
  float azimuth_rad = 0.7f, elevation_rad = 0.45f;
  Camera camera;  // stays while a handle is dragged
  Grips grips;
  ExportPlacement before;  // the drag
};

// Choices in the turntable dialog.
struct TurntableChoice {
  int frames = 72, width_px = 0, height_px = 0;  // 0: as large as the view
  std::string path;
  TurntableAs as = TurntableAs::kPictures;
  float turn_s = 3;
  bool overwrite = false;
  std::string proposed = {};  // a path that is still this one was not typed or chosen
};

// By-property selection of the repair panel.
struct PropertyChoice {
  int property = 0;  // a Property, or kColourProperty
  static constexpr int kColourProperty = 4;
  float low = 0, high = 1;
  glm::vec3 colour{0.5f};
  float tolerance = 0.1f;
  Histogram histogram;
  std::string histogram_key;           // what it was made of
  std::optional<Camera> histogram_of;  // view that it was made in; depths follow the view once it rests
};

// Rings of one pane, kept while nothing changes.
struct RingsShown {
  SplatRings rings;
  std::vector<Ring> in_view;
  std::uint64_t scene = 0, picture = 0;  // serials of what they were made for
  Flags shown, of_object;
  bool moving = false;
  std::optional<Camera> camera;
};

// Gaussians of one pane whose centres are drawn.
struct CentresShown {
  std::vector<std::uint32_t> gaussians;
  std::uint64_t scene = 0;  // serial
  Flags shown, of_object;
};

struct GridShown {
  GroundGrid grid;
  std::uint64_t scene = 0;  // serial
  glm::vec3 up_world{0};
};

// The file of the scene that is chosen in the files panel, and where it is to stand.
struct PlacingChoice {
  std::uint32_t file = 0;  // id; 0: none
  bool open = false;       // the panel's section is
  ScenePlace place;
  Grips grips;                        // in the picture
  ScenePlace before;                  // the drag
  std::vector<std::uint32_t> sample;  // of its Gaussians
  std::uint64_t sample_scene = 0;     // serial
  std::uint32_t sample_file = 0;
  std::size_t files_before = 1;  // the section opens when there are more
};

// What "Save..." was pressed before, where unsaved work would have been lost.
struct AfterSave {
  std::optional<OpenScene> open;      // none: the program ends
  std::size_t saves = 0, cursor = 0;  // number of saves before; step of the history that is to be saved
};

inline constexpr float kStatusHeight = 30;   // of the status bar
inline constexpr float kOptionsHeight = 44;  // of the options' first row under the bar, where they have one

struct UiRect {
  glm::vec2 min{0}, max{0};  // logical points
  glm::vec2 size() const { return max - min; }
  bool contains(const glm::vec2& p) const {
    return p.x >= min.x && p.y >= min.y && p.x < max.x && p.y < max.y;
  }
};

// What can be pressed, and the picture: where it lies in the last frame, in logical points.
struct ShownItem {
  std::string name;  // what stands on it, without ImGui's ids; "picture"
  glm::vec2 min{0}, max{0};
  bool operator==(const ShownItem&) const = default;
};

// The interface's own state: neither document nor view.
struct UiState {
  bool dark = true;
  float ui_scale = 1;  // on top of the screen's own
  bool help_open = false, settings_open = false, history_open = false, quit_asked = false,
       quit_wanted = false, export_open = false;
  std::optional<OpenScene> open_asked, open_now;  // open_asked: would discard unsaved work
  std::optional<AfterSave> after_save;            // waits for the file dialog and for the save
  std::optional<bool> history_wanted;             // opens or closes the history section
  std::size_t history_row = 0;                    // present step in the last frame that showed the section
  bool history_row_seen = false;                  // it was in sight
  bool hint_wanted = true;                        // the first-run hint, until the first click
  bool options_below = false;                     // those of the tool have no room in the bar
  bool depth_below = false;                       // the limit of depth alone has none
  bool row_below() const { return options_below || depth_below; }
  float options_height = kOptionsHeight;  // of their rows under it, as they were last
  double message_s = -1;                  // time of the message whose place was chosen
  std::size_t message_place = 0;          // of the corners in which it may lie
  std::vector<glm::vec2> badges;          // middles of the badges that this frame shows
  UiRect message;                         // where one shows; no size: none does
  std::string message_text;               // what the last one that showed said, as far as there was room
  std::string offer_words;                // behind the buttons of other meanings, as they were shown last
  bool double_clicked = false;            // the last press was the second of two, by the events' own times
  bool steady = false;                    // for pictures that must repeat: no times, no version, no blinking
  std::vector<std::filesystem::path> recent;
  std::filesystem::path sample;  // offered on the start page where it exists
  FileBrowser files;
  NativeDialog native_files;
  bool native_wanted = false;  // the desktop's own file dialog, where there is one
  FilePurpose file_purpose = FilePurpose::kOpen;
  std::optional<std::filesystem::path> replace_asked;  // a file of that name is there
  ExportChoice exporting;
  ExportPreview export_preview;
  std::optional<ViewState> view_before;  // with its switches before the dialog that is open
  bool turntable_open = false;
  TurntableChoice turntable;
  PropertyChoice property;
  std::optional<std::size_t>
      size_pointed;  // size of the last click whose step the pointer is at in the panel
  // Pointer when a thumbnail was clicked: until it moves, the picture is looked at, not the thumbnail's tip.
  std::optional<glm::vec2> looked_from_card_at;
  RingsShown rings[2];      // of each pane
  CentresShown centres[2];  // of each pane
  GridShown grid;
  PlacingChoice placing;
  std::optional<std::filesystem::path> dragged_out;  // by the pointer, into another program
  bool drags_out = false;                            // that began and the button is still held
  ObjectId renaming = 0;
  std::string new_name;
  std::string renderer_line;  // which renderer draws, and why
  std::vector<ShownItem> items;
  std::optional<ShownItem> marked;  // what Enter presses; Tab goes on from there
};

struct UiContext {
  const Studio& studio;
  UiState& state;
  Requests& ask;
  const Theme& theme;
  UiRenderer& renderer;
};

}  // namespace splatcut
