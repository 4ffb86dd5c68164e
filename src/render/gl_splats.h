// Draws a Gaussian cloud with OpenGL 3.3: EWA projection and SH in the vertex shader, blending back to front
// into 32-bit float targets (8-bit targets lose up to 100/255 on real scenes; 32F costs what 16F costs).
//
// In: cloud, back-to-front order, camera. Out: premultiplied colour; the selections' colours and
// shares of each pixel, blended the same way. The maths is that of scene/raster/splat_math.h; pictures differ
// from rasterize() by what T < 1e-4 still lets through. Source: Kerbl et al. 2023; Zwicker et al. 2001. Cost:
// 4 vertices a Gaussian, bound by fill on a software GL. Errors: Error where the scene is larger than the
// driver's texel buffers. Main thread only, context current.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "core/image.h"
#include "render/gl_objects.h"
#include "scene/camera/camera.h"
#include "scene/cloud/gaussian_cloud.h"
#include "scene/raster/splat_math.h"

namespace splatcut {

// Per Gaussian: the colour of the selection it belongs to, and bits: whether it shows, whether it is
// highlighted, and above them the number of the selection, 0: none.
using SplatStyle = std::array<std::uint8_t, 4>;
inline constexpr std::uint8_t kShownBit = 1, kHighlightedBit = 2;
inline constexpr unsigned kSelectionNumbers = 63;  // more selections share numbers

// Bits of what belongs to the n-th selection, counted from 1; of none: 0.
constexpr std::uint8_t selection_bits(unsigned n) {
  return n == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>((1 + (n - 1) % kSelectionNumbers) << 2);
}

struct SplatDrawOptions {
  float near_plane = 0.2f;  // camera z, scene units
  float far_plane = 1e30f;
  float low_pass_px2 = kLowPassPx2;
};

struct ResolveOptions {
  glm::vec3 background{0};
  float checker_px = 0;        // side of a checker's squares in place of the background; 0: none
  float tint_strength = 0;     // [0, 1]: how much of the selection colour covers the picture
  bool tint_shaded = false;    // the tint keeps the picture's light and dark
  float outline_strength = 0;  // [0, 1]
  bool highlighted = false;    // what has the bit is washed and outlined
  glm::vec3 highlight_colour{1};
};

class GlSplats {
 public:
  GlSplats();
  void upload(const GaussianCloud& cloud);  // shows all
  void share(const GlSplats& other);        // draws the cloud that the other holds, with styles of its own
  void upload_styles(std::span<const SplatStyle> styles);  // size of the cloud
  void upload_order(std::span<const std::uint32_t> back_to_front);

  // Into the float targets, in the camera's size.
  void draw(const Camera& camera, const SplatDrawOptions& options = {});

  // From the float targets to an RGBA8 texture, its first row the picture's top.
  void resolve(const ResolveOptions& options);
  GLuint picture_texture() const { return resolved_.texture(0); }

  // Reads the float target back: premultiplied colour and alpha, top row first.
  Image<glm::vec4> read_picture() const;

 private:
  static constexpr int kBatch = 16384;  // Gaussians whose four vertices a 16-bit index reaches

  GlProgram splat_program_, resolve_program_;
  GlVertexArray vertex_array_;
  GlBuffer indices_;
  struct Cloud {
    TexelBuffer geometry, colours;
    std::size_t gaussians = 0;
    int sh_degree = 0, sh_texels = 1;
    bool antialiased = false;
  };
  std::shared_ptr<const Cloud> cloud_;
  TexelBuffer order_, styles_;
  RenderTarget float_target_, resolved_;
  std::size_t ordered_ = 0;
};

}  // namespace splatcut
