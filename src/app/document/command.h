// Commands: everything that the user can ask for. Keys, menus, buttons, the pointer, files and tests send the
// same commands to Studio::apply(), so they cannot disagree.
//
// A command that changes the document declares up to three functions here. title() names its step in the
// history. merge_key(), if there is one, lets the command replace a last step that has the same key (a slider
// that moves). edit() changes a copy of the document and returns the text for the message strip;
// document_edits.cpp defines it. Expected refusals (a locked object, nothing selected) throw an Error worded
// for the user; the document stays as it was, because the caller drops its copy. Traits that a command may
// have:
//   passes       edit() passes over all Gaussians, so it runs on a worker, once no cut is on its way
//   after_cuts   the command, too, waits for the cuts that are on their way
//   at_once      the command does not wait for the edits that were asked for before it
//   writes_file  the command stays in the queue even if the edits before it are cancelled
//   no_loss      the command makes nothing that is lost if another scene is opened; others are refused while
//                one is on its way
//   no_work      the command is not a step of the history: every state of the history takes its change,
//                unless edit() refuses there. edit() refuses before it changes anything, and changes nothing
//                that labels depend on
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "app/document/document.h"
#include "app/document/export_plan.h"
#include "app/document/scene_sources.h"
#include "app/document/view_state.h"
#include "core/job.h"

namespace splatcut {

class SceneGraph;
struct GaussianCloud;

// Data that edits may read besides the document.
struct EditContext {
  const GaussianCloud& cloud;
  SceneGraph* graph = nullptr;  // graph of the cloud; null if no edit asks for neighbours
  Job job{};
  const Document* undone = nullptr;  // state that undo, redo or a jump led away from last; null: none
  LabelCache* labels = nullptr;      // cache of the thread that edits; null: it has none
};

template <class C>
constexpr bool kPasses = requires {
  requires C::passes;
};
template <class C>
constexpr bool kAfterCuts = kPasses<C> || requires {
  requires C::after_cuts;
};
template <class C>
constexpr bool kAtOnce = requires {
  requires C::at_once;
};
template <class C>
constexpr bool kWritesFile = requires {
  requires C::writes_file;
};

template <class C>
constexpr bool kNoWork = requires {
  requires C::no_work;
};
// True if the command makes work, which another scene would replace.
template <class C>
constexpr bool kMakesWork = !kAtOnce<C> && !kWritesFile<C> && !kNoWork<C> && !requires {
  requires C::no_loss;
};

template <class C>
std::string title_of(const C& command, const Document& document) {
  if constexpr (requires { command.title(document); })
    return command.title(document);
  else
    return command.title();
}

template <class C>
std::string merge_key_of(const C& command) {
  if constexpr (requires { command.merge_key(); }) return command.merge_key();
  return {};  // the command is always a step of its own
}

inline const char* title_of(SetOperation operation) {
  constexpr const char* kTitles[] = {"Add", "Remove", "Intersect"};
  return kTitles[static_cast<int>(operation)];
}

// Strokes and selections change the active object; they make an object if none is active.
struct AddStroke {
  Camera camera;
  Stroke stroke;                        // stroke in the camera's pixels
  Flags seen{};                         // Gaussians that the view shows; null: all
  std::vector<std::int32_t> hits = {};  // see hits_of(); Clicks finds them
  std::string title() const {
    return std::string(stroke.is_click() ? "Click" : "Scribble") +
           (stroke.label == SeedLabel::kRest ? ": rest" : ": object");
  }
  friend std::string edit(Document* document, const AddStroke& command, const EditContext& context);
};
struct IntersectStroke {  // keeps the part of the object that this stroke alone would take
  Camera camera;
  Stroke stroke;
  Flags seen{};
};
struct AddBox {
  Camera camera;
  glm::vec2 a_px, b_px;  // opposite corners
  Flags seen{};
  // kAdd makes the box a stroke. The others remove from the object, or keep of it, what the box alone would
  // cut out.
  SetOperation operation = SetOperation::kAdd;
  std::vector<std::int32_t> hits = {};  // see hits_of(); Clicks finds them
  std::string title() const { return "Box"; }
  friend std::string edit(Document* document, const AddBox& command, const EditContext& context);
};
struct SelectRegion {
  Camera camera;
  Mask region;  // mask of the camera's size
  SetOperation operation = SetOperation::kAdd;
  // Path of a brush, pixels: of what is visible, it takes the surface under the path, see surface_region().
  std::vector<glm::vec2> path_px = {};
  std::string shape = "shape";  // what drew the region, for the title: "brush", "lasso"
};
struct SelectVolume {
  Volume volume;
  SetOperation operation = SetOperation::kAdd;
  bool adjusts = false;  // true: replaces the last such selection, if no other step came since
};
struct SelectColour {
  glm::vec3 colour;  // base colour, [0, 1]
  float tolerance;   // largest difference in a channel, [0, 1]
  SetOperation operation = SetOperation::kAdd;
  bool operator==(const SelectColour&) const = default;
};
struct PickColour {  // selects all Gaussians of this one's colour, within ViewState::colour_tolerance
  std::int32_t gaussian;
  SetOperation operation = SetOperation::kAdd;
};
struct SelectFlood {  // selects what is connected to a Gaussian and has its colour, within that tolerance
  std::int32_t gaussian;
  SetOperation operation = SetOperation::kAdd;
};
struct SelectScene {   // selects the Gaussians of one of the scene's files
  std::uint32_t file;  // SceneSource::id
  SetOperation operation = SetOperation::kAdd;
};
struct SelectRange {
  Property property;
  float low, high;  // limits, both included, in units of property_values()
  SetOperation operation = SetOperation::kAdd;
  bool operator==(const SelectRange&) const = default;
};
using SelectRangeOrColour = std::variant<SelectRange, SelectColour>;
struct ShowRange {                           // outlines what that would be about, and selects nothing
  std::optional<SelectRangeOrColour> range;  // none: no outline
  static constexpr bool at_once = true;
};
enum class SelectionEdit { kAll, kNone, kInvert, kGrow, kShrink, kLargestPart, kRemoveFloaters };
struct EditSelection {
  SelectionEdit edit;
  std::string title() const;
  static constexpr bool passes = true;
  friend std::string edit(Document* document, const EditSelection& command, const EditContext& context);
};
struct ShowPlaced {    // F frames this file while it is placed, see Viewport::placing()
  std::uint32_t file;  // SceneSource::id; 0: none
  static constexpr bool at_once = true;
};
struct DrawLarger {
  std::uint64_t card;  // ViewCard::serial of a thumbnail
  static constexpr bool at_once = true;
};
struct ShowFloaters {
  bool shown;  // true: previews floaters; EditSelection{kRemoveFloaters} removes them
  static constexpr bool at_once = true;
};
struct StepScale {
  int steps;  // steps to larger (+) or smaller (-) sizes of what the active object's last stroke means
  std::string title(const Document& document) const;  // says whether that takes away
  friend std::string edit(Document* document, const StepScale& command, const EditContext& context);
};
struct ChooseMeaning {
  int choice;  // number of the meaning that the active object's first click gets, 0 the likeliest
  std::string title(const Document& document) const;  // says whether a click or a box is meant
  friend std::string edit(Document* document, const ChooseMeaning& command, const EditContext& context);
};
// Takes a click of the active object away; where no stroke marks the object then, the others, too.
struct RemoveStroke {
  std::size_t view = 0, stroke = 0;  // indices into ObjectItem::views and the strokes of that
  glm::vec2 at_px{0};                // its place, by which it is known
  std::string title() const { return "Take a click away"; }
  friend std::string edit(Document* document, const RemoveStroke& command, const EditContext& context);
};
struct ClearStrokes {
  std::string title() const { return "Clear strokes"; }
  friend std::string edit(Document* document, const ClearStrokes& command, const EditContext& context);
};
struct ComeNearer {  // moves the camera towards the place where the active object was clicked
  static constexpr bool no_loss = true;
};

// Commands on objects.
struct NewObject {
  ObjectId within = 0;  // object of which the new one is a part; 0: none
  std::string title() const { return "New object"; }
  friend std::string edit(Document* document, const NewObject& command, const EditContext& context);
};
struct RemoveObject {
  ObjectId object;
  std::string title() const { return "Remove object"; }
  friend std::string edit(Document* document, const RemoveObject& command, const EditContext& context);
};
struct RenameObject {
  ObjectId object;
  std::string name;
  std::string title() const { return "Rename to " + name; }
  friend std::string edit(Document* document, const RenameObject& command, const EditContext& context);
};
struct RecolourObject {
  ObjectId object;
  Rgb8 colour;
  std::string title() const { return "Colour"; }
  std::string merge_key() const { return "colour " + std::to_string(object); }
  friend std::string edit(Document* document, const RecolourObject& command, const EditContext& context);
};
struct TintObject {
  ObjectId object;
  bool tinted;
  std::string title() const { return tinted ? "Show tint" : "Hide tint"; }
  friend std::string edit(Document* document, const TintObject& command, const EditContext& context);
};
struct LockObject {
  ObjectId object;
  bool locked;
  std::string title() const { return locked ? "Lock object" : "Unlock object"; }
  friend std::string edit(Document* document, const LockObject& command, const EditContext& context);
};
struct ActivateObject {
  ObjectId object;
  static constexpr bool no_work = true;
  friend std::string edit(Document* document, const ActivateObject& command, const EditContext& context);
};
struct MergeObjects {
  ObjectId into, from;
  std::string title() const { return "Merge objects"; }
  static constexpr bool passes = true;
  friend std::string edit(Document* document, const MergeObjects& command, const EditContext& context);
};
struct SplitObject {
  ObjectId object;
  std::string title() const { return "Split object"; }
  static constexpr bool passes = true;
  friend std::string edit(Document* document, const SplitObject& command, const EditContext& context);
};
struct DuplicateObject {
  ObjectId object;
  std::string title() const { return "Duplicate object"; }
  static constexpr bool passes = true;
  friend std::string edit(Document* document, const DuplicateObject& command, const EditContext& context);
};
struct SeparateObject {
  ObjectId object;
  std::string title() const { return "Separate object"; }
  static constexpr bool passes = true;
  friend std::string edit(Document* document, const SeparateObject& command, const EditContext& context);
};
struct LeaveToOthers {  // whether the object's cut takes what the other objects have now
  ObjectId object;
  bool leaves;
  std::string title() const { return leaves ? "Without the other objects" : "With what others have"; }
  static constexpr bool passes = true;
  friend std::string edit(Document* document, const LeaveToOthers& command, const EditContext& context);
};
struct DeleteSelected {
  std::string title() const { return "Delete from the scene"; }
  static constexpr bool passes = true;
  friend std::string edit(Document* document, const DeleteSelected& command, const EditContext& context);
};
struct RestoreDeleted {
  std::string title() const { return "Restore deleted"; }
  static constexpr bool passes = true;
  friend std::string edit(Document* document, const RestoreDeleted& command, const EditContext& context);
};
struct LeaveOutView {
  ObjectId object;
  Camera view;
  bool left_out;
  std::string title() const { return left_out ? "Leave out a view" : "Use a view"; }
  friend std::string edit(Document* document, const LeaveOutView& command, const EditContext& context);
};

// Commands on settings that change the result.
struct SetSmoothness {
  ObjectId object;
  std::optional<float> smoothness;  // none: the method's own
  std::string title() const { return "Smoothness"; }
  std::string merge_key() const { return "smoothness " + std::to_string(object); }
  friend std::string edit(Document* document, const SetSmoothness& command, const EditContext& context);
};
struct SetPreset {
  std::string preset;
  std::string title() const { return "Method: " + preset; }
  friend std::string edit(Document* document, const SetPreset& command, const EditContext& context);
};
struct SetBackground {
  glm::vec3 colour;
  static constexpr bool no_work = true;
  friend std::string edit(Document* document, const SetBackground& command, const EditContext& context);
};
struct SetUp {
  glm::vec3 up_world;
  std::string title() const { return "Set up direction"; }
  friend std::string edit(Document* document, const SetUp& command, const EditContext& context);
};

// Commands on the history and on running work.
struct Undo {
  static constexpr bool no_loss = true;
};
struct Redo {
  static constexpr bool no_loss = true;
};
struct JumpHistory {
  std::size_t entry;
  static constexpr bool no_loss = true;
};
struct Cancel {
  static constexpr bool at_once = true;
};
struct Recompute {
  static constexpr bool no_loss = true;
};

// Commands on the view: the history does not hold them.
struct SetView {
  ViewState view;
  static constexpr bool at_once = true;
};
struct GoToCamera {
  Camera camera;
  static constexpr bool at_once = true;
};
struct LookAlong {
  glm::vec3 direction_world;  // direction of the view, of any length but 0
  static constexpr bool at_once = true;
};
struct NextBackdrop {
  static constexpr bool at_once = true;
};
struct SetBackdrop {
  std::size_t number;  // index in backdrops()
  static constexpr bool at_once = true;
};
struct SetFieldOfView {
  float fov_y_rad;
  static constexpr bool at_once = true;
};

// Commands on files.
struct OpenScene {
  std::filesystem::path path;                     // a scene or a work file
  std::optional<SpzAxes> spz_axes = {};           // axes as in LoadOptions; a work file holds its own
  std::vector<std::filesystem::path> added = {};  // further scenes, see AddScene
  // Level of detail, as in LoadOptions; without it the finest that the free memory holds.
  std::optional<unsigned> lod = {};
  std::filesystem::path cameras = {};  // in place of those beside the scene; a work file holds its own
  std::string camera = {};             // which of them to begin with, by name or number; empty: the first
  static constexpr bool at_once = true;
};
struct AddScene {
  std::filesystem::path path;  // a scene
  std::optional<SpzAxes> spz_axes = {};
  std::optional<glm::vec3> onto_world = {};  // point to stand on, upright; none: its own coordinates hold
};
struct PlaceScene {
  std::uint32_t file;  // SceneSource::id of any file but the first
  ScenePlace place;
  std::string done = {};  // what its step says of the file; empty: moved, turned or scaled, as it is
};
struct BringHere {  // stands the file on the surface in the middle of the picture, see surface_in_middle()
  std::uint32_t file;
};
struct RemoveScene {
  std::uint32_t file;
};
struct SaveWork {
  std::filesystem::path path;
  static constexpr bool writes_file = true;
};
struct DropAutosave {
  std::filesystem::path file;  // of work that a crash left
  static constexpr bool at_once = true;
};
struct Export {
  ExportRequest request;
  std::string title() const { return "Export"; }
  static constexpr bool writes_file = true, after_cuts = true;
};
struct KeepFill {  // what fills the hole becomes a file of the scene and an object, in place of what it
                   // replaces
  std::filesystem::path path;  // a .ply
  static constexpr bool writes_file = true;
};
struct SaveSnapshot {
  std::filesystem::path path;
  bool transparent = true;
  std::string title() const { return "Picture"; }
  static constexpr bool writes_file = true, after_cuts = true;
};
struct SaveTurntable {
  std::filesystem::path path;  // a folder for pictures; a file for an animation or a video
  int frames = 72;
  int width_px = 0, height_px = 0;  // size of a picture; 0: size of the view
  TurntableAs as = TurntableAs::kPictures;
  float turn_s = 3;  // duration of one turn in an animation or a video, seconds
  bool clean_edges = false;
  std::string title() const { return "Turntable"; }
  static constexpr bool writes_file = true, after_cuts = true;
};

using Command =
    std::variant<AddStroke, IntersectStroke, AddBox, SelectRegion, SelectVolume, SelectColour, PickColour,
                 SelectFlood, SelectScene, SelectRange, ShowRange, EditSelection, ShowPlaced, DrawLarger,
                 ShowFloaters, StepScale, ChooseMeaning, RemoveStroke, ClearStrokes, ComeNearer, NewObject,
                 RemoveObject, RenameObject, RecolourObject, TintObject, LockObject, ActivateObject,
                 MergeObjects, SplitObject, DuplicateObject, SeparateObject, LeaveToOthers, DeleteSelected,
                 RestoreDeleted, LeaveOutView, SetSmoothness, SetPreset, SetBackground, SetUp, Undo, Redo,
                 JumpHistory, Cancel, Recompute, SetView, GoToCamera, LookAlong, NextBackdrop, SetBackdrop,
                 SetFieldOfView, OpenScene, AddScene, PlaceScene, BringHere, RemoveScene, SaveWork,
                 DropAutosave, Export, KeepFill, SaveSnapshot, SaveTurntable>;

}  // namespace splatcut
