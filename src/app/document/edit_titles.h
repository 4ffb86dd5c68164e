// Titles of the history, and the keys by which a slider's steps become one.
#pragma once

#include <fmt/format.h>

#include <string>

#include "app/document/command.h"

namespace splatcut {

inline const char* title_of(SetOperation operation) {
  switch (operation) {
    case SetOperation::kAdd:
      return "Add";
    case SetOperation::kRemove:
      return "Remove";
    case SetOperation::kIntersect:
      return "Intersect";
  }
  return "";
}

inline std::string title_of(const EditSelection& c) {
  switch (c.edit) {
    case SelectionEdit::kAll:
      return "Select all";
    case SelectionEdit::kNone:
      return "Select none";
    case SelectionEdit::kInvert:
      return "Invert";
    case SelectionEdit::kGrow:
      return "Grow";
    case SelectionEdit::kShrink:
      return "Shrink";
    case SelectionEdit::kLargestPart:
      return "Largest part";
    case SelectionEdit::kRemoveFloaters:
      return "Remove floaters";
  }
  return "";
}

inline std::string title_of(const AddStroke& c) {
  return fmt::format("{}: {}", c.stroke.points_px.size() == 1 ? "Click" : "Scribble",
                     c.stroke.label == SeedLabel::kRest ? "rest" : "object");
}
inline std::string title_of(const AddBox&) {
  return "Box";
}
inline std::string title_of(const ClearStrokes&) {
  return "Clear strokes";
}
inline std::string title_of(const StepScale& c) {
  return c.steps > 0 ? "Larger part" : "Smaller part";
}
inline std::string title_of(const ChooseMeaning& c) {
  return fmt::format("Meaning {} of the click", c.choice + 1);
}
inline std::string title_of(const LeaveOutView& c) {
  return c.left_out ? "Leave out a view" : "Use a view";
}

inline std::string title_of(const NewObject&) {
  return "New object";
}
inline std::string title_of(const RemoveObject&) {
  return "Remove object";
}
inline std::string title_of(const RenameObject& c) {
  return "Rename to " + c.name;
}
inline std::string title_of(const RecolourObject&) {
  return "Colour";
}
inline std::string title_of(const ShowObject& c) {
  return c.visible ? "Show object" : "Hide object";
}
inline std::string title_of(const LockObject& c) {
  return c.locked ? "Lock object" : "Unlock object";
}
inline std::string title_of(const ActivateObject&) {
  return "Choose object";
}
inline std::string title_of(const MergeObjects&) {
  return "Merge objects";
}
inline std::string title_of(const SplitObject&) {
  return "Split object";
}
inline std::string title_of(const DuplicateObject&) {
  return "Duplicate object";
}
inline std::string title_of(const SeparateObject&) {
  return "Separate object";
}
inline std::string title_of(const DeleteSelected&) {
  return "Delete from the scene";
}
inline std::string title_of(const RestoreDeleted&) {
  return "Restore deleted";
}

inline std::string title_of(const SetSmoothness&) {
  return "Smoothness";
}
inline std::string title_of(const SetPreset& c) {
  return "Quality: " + c.preset;
}
inline std::string title_of(const SetBackground&) {
  return "Background";
}
inline std::string title_of(const SetUp&) {
  return "Set up direction";
}

template <class Other>
std::string merge_key_of(const Other&) {
  return {};  // a step of its own
}
inline std::string merge_key_of(const SetSmoothness& c) {
  return fmt::format("smoothness {}", c.object);
}
inline std::string merge_key_of(const SetBackground&) {
  return "background";
}
inline std::string merge_key_of(const RecolourObject& c) {
  return fmt::format("colour {}", c.object);
}

}  // namespace splatcut
