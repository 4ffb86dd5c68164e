// Everything the user can ask for. Keys, menus, buttons, the pointer, files and tests send the same commands
// to Studio::apply(), so they cannot disagree.
#pragma once

#include <filesystem>
#include <variant>

#include "app/document/document.h"
#include "app/document/export_plan.h"
#include "app/document/scene_sources.h"
#include "app/document/view_state.h"

namespace splatcut {

// Strokes and selections; they make an object where none is active.
struct AddStroke {
  Camera camera;
  Stroke stroke;  // in the camera's pixels
  Flags seen{};   // Gaussians on the screen; null: all
};
struct IntersectStroke {  // keeps of the object what this stroke alone would take
  Camera camera;
  Stroke stroke;
  Flags seen{};
};
struct AddBox {
  Camera camera;
  glm::vec2 a_px, b_px;  // opposite corners
  Flags seen{};
  // Otherwise than kAdd: removes from the object, or keeps of it, what the box alone would cut out.
  SetOperation operation = SetOperation::kAdd;
};
struct SelectRegion {
  Camera camera;
  Mask region;  // in the camera's size
  SetOperation operation = SetOperation::kAdd;
};
struct SelectVolume {
  Volume volume;
  SetOperation operation = SetOperation::kAdd;
  bool adjusts = false;  // replaces the last such selection, if nothing else was done since
};
struct SelectColour {
  glm::vec3 colour;
  float tolerance;
  SetOperation operation = SetOperation::kAdd;
};
struct PickColour {  // selects by a Gaussian's colour, within the view's tolerance
  std::int32_t gaussian;
  SetOperation operation = SetOperation::kAdd;
};
struct SelectFlood {  // what is connected to a Gaussian and has its colour, within that tolerance
  std::int32_t gaussian;
  SetOperation operation = SetOperation::kAdd;
};
struct SelectScene {  // the Gaussians of one of the scene's files
  std::uint32_t file;
  SetOperation operation = SetOperation::kAdd;
};
struct SelectRange {
  Property property;
  float low, high;
  SetOperation operation = SetOperation::kAdd;
};
enum class SelectionEdit { kAll, kNone, kInvert, kGrow, kShrink, kLargestPart, kRemoveFloaters };
struct EditSelection {
  SelectionEdit edit;
};
struct ShowFloaters {
  bool shown;  // a preview; EditSelection{kRemoveFloaters} removes them
};
struct StepScale {
  int steps;  // of the active object's first click: to larger (+) or smaller (-) parts
};
struct ChooseMeaning {
  int choice;  // of what the active object's first click can mean, 0 the likeliest
};
struct ClearStrokes {};
struct ComeNearer {};  // to where the active object was clicked

// Objects.
struct NewObject {
  ObjectId within = 0;
};
struct RemoveObject {
  ObjectId object;
};
struct RenameObject {
  ObjectId object;
  std::string name;
};
struct RecolourObject {
  ObjectId object;
  Rgb8 colour;
};
struct ShowObject {
  ObjectId object;
  bool visible;
};
struct LockObject {
  ObjectId object;
  bool locked;
};
struct ActivateObject {
  ObjectId object;
};
struct MergeObjects {
  ObjectId into, from;
};
struct SplitObject {
  ObjectId object;
};
struct DuplicateObject {
  ObjectId object;
};
struct SeparateObject {
  ObjectId object;
};
struct DeleteSelected {};
struct RestoreDeleted {};
struct LeaveOutView {
  ObjectId object;
  Camera view;
  bool left_out;
};

// Settings that change the result.
struct SetSmoothness {
  ObjectId object;
  float smoothness;
};
struct SetPreset {
  std::string preset;
};
struct SetBackground {
  glm::vec3 colour;
};
struct SetUp {
  glm::vec3 up_world;
};

// Work.
struct Undo {};
struct Redo {};
struct JumpHistory {
  std::size_t entry;
};
struct Cancel {};
struct Recompute {};

// Looking: never undone.
struct SetView {
  ViewState view;
};
struct GoToCamera {
  Camera camera;
};
struct LookAlong {
  glm::vec3 direction_world;  // of the view, any length but 0
};
struct NextBackdrop {};
struct SetBackdrop {
  std::size_t number;  // in backdrops()
};
struct SetFieldOfView {
  float fov_y_rad;
};

// Files.
struct OpenScene {
  std::filesystem::path path;                     // a scene or a work file
  std::optional<SpzAxes> spz_axes = {};           // as LoadOptions has it; a work file says its own
  std::vector<std::filesystem::path> added = {};  // further scenes, see AddScene
};
struct AddScene {
  std::filesystem::path path;  // a scene, put where its own coordinates say
  std::optional<SpzAxes> spz_axes = {};
};
struct PlaceScene {
  std::uint32_t file;  // id in OpenedScene::files, not the first
  ScenePlace place;
};
struct RemoveScene {
  std::uint32_t file;
};
struct SaveWork {
  std::filesystem::path path;
};
struct DropAutosave {};
struct Export {
  ExportRequest request;
};
struct SaveSnapshot {
  std::filesystem::path path;
  bool transparent = true;
};
struct SaveTurntable {
  std::filesystem::path path;  // a folder, or a file of animation or video
  int frames = 72;
  int width_px = 0, height_px = 0;  // 0: as large as the view
  TurntableAs as = TurntableAs::kPictures;
  float turn_s = 3;  // of animation and video
};

using Command =
    std::variant<AddStroke, IntersectStroke, AddBox, SelectRegion, SelectVolume, SelectColour, PickColour,
                 SelectFlood, SelectScene, SelectRange, EditSelection, ShowFloaters, StepScale, ChooseMeaning,
                 ClearStrokes, ComeNearer, NewObject, RemoveObject, RenameObject, RecolourObject, ShowObject,
                 LockObject, ActivateObject, MergeObjects, SplitObject, DuplicateObject, SeparateObject,
                 DeleteSelected, RestoreDeleted, LeaveOutView, SetSmoothness, SetPreset, SetBackground, SetUp,
                 Undo, Redo, JumpHistory, Cancel, Recompute, SetView, GoToCamera, LookAlong, NextBackdrop,
                 SetBackdrop, SetFieldOfView, OpenScene, AddScene, PlaceScene, RemoveScene, SaveWork,
                 DropAutosave, Export, SaveSnapshot, SaveTurntable>;

}  // namespace splatcut
