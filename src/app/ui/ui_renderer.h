// ImGui's draw lists and the pictures they show, drawn by render's triangle renderer: no back end of ImGui's
// own, so that GLFW, EGL and OSMesa contexts look alike. Main thread, context current.
#pragma once

#include <imgui.h>

#include <map>
#include <memory>

#include "core/image.h"
#include "render/triangle_renderer.h"

namespace splatcut {

class UiRenderer {
 public:
  void upload_fonts();  // of the current ImGui context, after load_fonts()

  // The texture of a picture; uploaded where the serial is new under this key. Pictures not asked for during
  // a frame go in end_frame().
  ImTextureID texture(std::uint64_t key, std::uint64_t serial, const Image<Rgba8>& picture);
  void draw(const ImDrawData& data);
  void end_frame();

 private:
  struct Picture {
    PictureTexture texture;
    std::uint64_t serial = 0;
    bool asked = false;
  };
  TriangleRenderer triangles_;
  PictureTexture fonts_;
  std::map<std::uint64_t, Picture> pictures_;
};

inline ImTextureID texture_id(GLuint id) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(id));
}

}  // namespace splatcut
