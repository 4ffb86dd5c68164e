#include "app/ui/ui_renderer.h"

#include <cstddef>
#include <span>
#include <vector>

namespace splatcut {

static_assert(sizeof(ImDrawVert) == sizeof(TriangleVertex) &&
              offsetof(ImDrawVert, uv) == offsetof(TriangleVertex, uv) &&
              offsetof(ImDrawVert, col) == offsetof(TriangleVertex, colour) &&
              sizeof(ImDrawIdx) == sizeof(std::uint16_t));

void UiRenderer::upload_fonts() {
  unsigned char* rgba = nullptr;
  int width = 0, height = 0;
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.GetTexDataAsRGBA32(&rgba, &width, &height);
  fonts_.upload(std::as_bytes(std::span(rgba, 4 * static_cast<std::size_t>(width) * height)), width, height);
  atlas.SetTexID(texture_id(fonts_.id()));
}

ImTextureID UiRenderer::texture(std::uint64_t key, std::uint64_t serial, const Image<Rgba8>& picture) {
  Picture& p = pictures_[key];
  p.asked = true;
  if (p.serial != serial) {
    p.texture.upload(std::as_bytes(picture.pixels()), picture.width(), picture.height());
    p.serial = serial;
  }
  return texture_id(p.texture.id());
}

void UiRenderer::draw(const ImDrawData& data) {
  triangles_.begin({data.DisplaySize.x, data.DisplaySize.y},
                   {data.FramebufferScale.x, data.FramebufferScale.y});
  std::vector<TriangleBatch> batches;
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    batches.clear();
    for (const ImDrawCmd& command : list.CmdBuffer)
      batches.push_back({{command.ClipRect.x, command.ClipRect.y, command.ClipRect.z, command.ClipRect.w},
                         static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(command.GetTexID())),
                         command.IdxOffset,
                         command.ElemCount,
                         command.VtxOffset});
    triangles_.draw({{reinterpret_cast<const TriangleVertex*>(list.VtxBuffer.Data),
                      static_cast<std::size_t>(list.VtxBuffer.Size)},
                     {list.IdxBuffer.Data, static_cast<std::size_t>(list.IdxBuffer.Size)},
                     batches});
  }
}

void UiRenderer::end_frame() {
  std::erase_if(pictures_, [](const auto& p) { return !p.second.asked; });
  for (auto& [key, picture] : pictures_) picture.asked = false;
}

}  // namespace splatcut
