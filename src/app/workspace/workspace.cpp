#include "app/workspace/workspace.h"

#include "core/error.h"

namespace splatcut {

std::size_t Workspace::gaussians_of(ObjectId object) const {
  const ObjectItem* item = document().find(object);
  return item && scene ? labels.count(document(), *item, gaussians()) : 0;
}

void Workspace::require_scene() const {
  if (!scene) throw Error("", "No scene is open", "Open one with Ctrl+O, or drop a file on the window");
}

void Workspace::say(Message::Kind kind, std::string text) {
  constexpr std::size_t kKept = 100;
  messages.push_back({kind, std::move(text), clock_s});
  if (messages.size() > kKept) messages.pop_front();
}

void Workspace::say_also(Message::Kind kind, const std::string& text) {
  if (!add_to_shown(kind, text, clock_s, &messages)) say(kind, text);
}

}  // namespace splatcut
