// Functions that edits of a document share with their callers. Each command declares its own edit, see
// command.h.
#pragma once

#include <string>

#include "app/document/command.h"
#include "app/document/history.h"

namespace splatcut {

// A background that the user can put behind the scene.
struct Backdrop {
  const char* name;
  glm::vec3 colour;
  bool checker = false;
};
std::span<const Backdrop> backdrops();
// True if the view shows this backdrop now.
bool shows(const Backdrop& backdrop, const Document& document, const ViewState& view);

// Combines the active object's labels with a selection that any tool found. Makes an object if none is
// active. Returns the text for the message strip. Throws Error if the object is locked.
std::string edit_selection(Document* document, const Selection& region, SetOperation operation,
                           const EditContext& context);

// The same with a shape drawn in the picture or in space. As with a box of strokes, what it adds leaves other
// objects what they have: a new object's first shape what all have, a later one what the object leaves to
// them already; unless more than half of it is another's. What it leaves becomes the object's once
// it no longer leaves it.
std::string edit_by_shape(Document* document, const Selection& region, SetOperation operation,
                          const EditContext& context);

// Whether the next stroke that marks the object begins it: nothing marks it yet, and it has no Gaussians.
bool is_begun_by_next(const Document& document, const ObjectItem& object, const EditContext& context);

// Says of a box that it added to the object, and how a box begins one; empty: the last step is no box, or
// began the object.
std::string added_by_box(const History& history, ObjectId id, const EditContext& context);

// Whether it matters what a stroke of that label is made on: it begins the active object, or that leaves
// something to others, or is not cut among all there is.
bool asks_what_is_hit(const Document& document, SeedLabel label, const EditContext& context);

// What a stroke that marks the active object, or begins one, leaves to others unless it means that.
Flags left_by_stroke(const Document& document, const EditContext& context);

// A click can end what its object leaves to others, but for what locked ones keep, or the limits that it is
// cut among (ObjectItem::of_others, leaves_also, among). Where such a click was taken away, gives the active
// object those back that the history knows, unless they were changed again since. document: a copy of now(),
// without the click.
void take_back_sharing(const History& history, const RemoveStroke& gone, Document* document,
                       std::size_t gaussians, LabelCache* known = nullptr);

// Gaussians whose labels a stroke changes, where the cut alone gives the active object `before` without it
// and `after` it with it. left: left_by_stroke().
Flags changed_by(const Document& document, const AddStroke& stroke, std::vector<std::uint8_t> before,
                 std::vector<std::uint8_t> after, const Flags& left, const EditContext& context);

// The stroke that a box stands for. Throws Error if the box is too small.
Stroke stroke_of(const AddBox& command, SeedLabel label);

}  // namespace splatcut
