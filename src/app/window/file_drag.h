// A file that is dragged out of the window into another program, by the Xdnd protocol (version 5,
// freedesktop.org), with a connection of its own: GLFW takes drops and makes none. Where there is no X11,
// as under Wayland without Xwayland, nothing is dragged.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace splatcut {

class FileDrag {
 public:
  FileDrag();
  ~FileDrag();
  FileDrag(const FileDrag&) = delete;
  FileDrag& operator=(const FileDrag&) = delete;

  // While the left button is held. The file is offered to the program under the pointer when it is released.
  void begin(const std::filesystem::path& file);
  // Often: follows the pointer, answers the other program. False where nothing is being dragged or handed
  // over.
  bool update();

 private:
  struct Source;
  std::unique_ptr<Source> source_;  // null: none
};

// "file:///a%20b.ply", for text/uri-list. The path is absolute.
std::string file_uri(const std::filesystem::path& file);

}  // namespace splatcut
