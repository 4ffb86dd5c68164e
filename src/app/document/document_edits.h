// What edits of documents share with what calls them; the edits themselves are declared by their commands.
#pragma once

#include <string>

#include "app/document/command.h"

namespace splatcut {

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

Stroke stroke_of(const AddBox& command, SeedLabel label);  // throws Error where the box is too small

}  // namespace splatcut
