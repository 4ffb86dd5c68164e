// The commands that change objects, as functions from a document to the next one. No threads, no window.
// Each returns what the message strip says. Expected refusals (a locked object, nothing selected) are Errors
// worded for the user; the document is then unchanged because the caller drops its copy.
#pragma once

#include <string>

#include "app/document/command.h"
#include "app/document/scene_graph.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

// What edits may read.
struct EditContext {
  const GaussianCloud& cloud;
  SceneGraph* graph = nullptr;  // of the cloud; null if no edit asks for neighbours
  Job job{};
};

std::string edit(Document* document, const AddStroke& command, const EditContext& context);
std::string edit(Document* document, const AddBox& command, const EditContext& context);
std::string edit(Document* document, const EditSelection& command, const EditContext& context);
std::string edit(Document* document, const ClearStrokes& command, const EditContext& context);
std::string edit(Document* document, const NewObject& command, const EditContext& context);
std::string edit(Document* document, const RemoveObject& command, const EditContext& context);
std::string edit(Document* document, const RenameObject& command, const EditContext& context);
std::string edit(Document* document, const RecolourObject& command, const EditContext& context);
std::string edit(Document* document, const ShowObject& command, const EditContext& context);
std::string edit(Document* document, const LockObject& command, const EditContext& context);
std::string edit(Document* document, const ActivateObject& command, const EditContext& context);
std::string edit(Document* document, const MergeObjects& command, const EditContext& context);
std::string edit(Document* document, const SplitObject& command, const EditContext& context);
std::string edit(Document* document, const DuplicateObject& command, const EditContext& context);
std::string edit(Document* document, const SeparateObject& command, const EditContext& context);
std::string edit(Document* document, const DeleteSelected& command, const EditContext& context);
std::string edit(Document* document, const RestoreDeleted& command, const EditContext& context);
std::string edit(Document* document, const StepScale& command, const EditContext& context);
std::string edit(Document* document, const ChooseMeaning& command, const EditContext& context);
std::string edit(Document* document, const LeaveOutView& command, const EditContext& context);
std::string edit(Document* document, const SetSmoothness& command, const EditContext& context);
std::string edit(Document* document, const SetPreset& command, const EditContext& context);
std::string edit(Document* document, const SetBackground& command, const EditContext& context);
std::string edit(Document* document, const SetUp& command, const EditContext& context);

// What can stand behind the scene.
struct Backdrop {
  const char* name;
  glm::vec3 colour;
  bool checker = false;
};
std::span<const Backdrop> backdrops();
bool shows(const Backdrop& backdrop, const Document& document, const ViewState& view);

// The active object's labels, combined with a selection found by any tool.
std::string edit_selection(Document* document, const Selection& region, SetOperation operation,
                           const EditContext& context);

// Strokes of a box in a picture of that size: its border is rest, and all around it where that is said; the
// middle of what is inside of the picture is object.
Strokes box_strokes(const glm::vec2& a_px, const glm::vec2& b_px, const glm::vec2& picture_px,
                    bool all_around);
Strokes strokes_of(const AddBox& command, bool all_around);  // throws Error where the box is too small

}  // namespace splatcut
