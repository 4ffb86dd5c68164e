#include "render/gl_splats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <vector>

#include "core/error.h"
#include "render/read_back.h"
#include "render/shader_sources.h"
#include "scene/raster/splat_math.h"

namespace splatcut {

namespace {

void check_texels(std::size_t texels, std::size_t gaussians) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
  if (texels > static_cast<std::size_t>(limit))
    throw Error("OpenGL", fmt::format("{} Gaussians are more than this driver's buffers hold", gaussians),
                "Start with --renderer cpu");
}

std::vector<glm::vec4> geometry_of(const GaussianCloud& cloud) {
  std::vector<glm::vec4> texels(3 * cloud.size());
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const glm::mat3 s = covariance_world(cloud.scale[g], cloud.rotation[g]);
    texels[3 * g] = glm::vec4(cloud.position[g], cloud.opacity[g]);
    texels[3 * g + 1] = {s[0][0], s[0][1], s[0][2], s[1][1]};
    texels[3 * g + 2] = {s[1][2], s[2][2], 0, 0};
  }
  return texels;
}

// f_dc and the rest, the three channels of a coefficient side by side, padded to whole texels.
std::vector<float> colours_of(const GaussianCloud& cloud, int texels_each) {
  const int rest = sh_rest_coefficients(cloud.sh_degree);
  std::vector<float> values(cloud.size() * static_cast<std::size_t>(texels_each) * 4, 0.0f);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    float* out = values.data() + g * static_cast<std::size_t>(texels_each) * 4;
    const std::span<const float> sh = cloud.sh_rest_of(g);
    for (int c = 0; c < 3; ++c) {
      out[c] = cloud.f_dc[g][c];
      for (int k = 0; k < rest; ++k) out[3 * (k + 1) + c] = sh[static_cast<std::size_t>(c * rest + k)];
    }
  }
  return values;
}

}  // namespace

GlSplats::GlSplats()
    : splat_program_("splat", kSplatVert, kSplatFrag),
      resolve_program_("resolve", kResolveVert, kResolveFrag) {
  std::vector<std::uint16_t> indices;
  indices.reserve(6 * kBatch);
  for (int quad = 0; quad < kBatch; ++quad)
    for (const int corner : {0, 1, 2, 2, 1, 3})
      indices.push_back(static_cast<std::uint16_t>(4 * quad + corner));
  glBindVertexArray(vertex_array_.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(indices[0])),
               indices.data(), GL_STATIC_DRAW);
}

void GlSplats::upload(const GaussianCloud& cloud) {
  const auto made = std::make_shared<Cloud>();
  made->gaussians = cloud.size();
  made->sh_degree = cloud.sh_degree;
  made->antialiased = cloud.antialiased;
  made->sh_texels = (3 * (1 + sh_rest_coefficients(cloud.sh_degree)) + 3) / 4;
  check_texels(made->gaussians * static_cast<std::size_t>(std::max(3, made->sh_texels)), made->gaussians);
  const std::vector<glm::vec4> geometry = geometry_of(cloud);
  made->geometry.upload(GL_RGBA32F, std::as_bytes(std::span(geometry)), GL_STATIC_DRAW);
  const std::vector<float> colours = colours_of(cloud, made->sh_texels);
  made->colours.upload(GL_RGBA32F, std::as_bytes(std::span(colours)), GL_STATIC_DRAW);
  cloud_ = made;
  ordered_ = 0;
  upload_styles(std::vector<SplatStyle>(cloud.size(), SplatStyle{0, 0, 0, kShownBit}));
}

void GlSplats::share(const GlSplats& other) {
  cloud_ = other.cloud_;
  ordered_ = 0;
  if (cloud_) upload_styles(std::vector<SplatStyle>(cloud_->gaussians, SplatStyle{0, 0, 0, kShownBit}));
}

void GlSplats::upload_styles(std::span<const SplatStyle> styles) {
  assert(cloud_ && styles.size() == cloud_->gaussians);
  styles_.upload(GL_RGBA8, std::as_bytes(styles), GL_DYNAMIC_DRAW);
}

void GlSplats::upload_order(std::span<const std::uint32_t> back_to_front) {
  assert(cloud_ && back_to_front.size() <= cloud_->gaussians);
  ordered_ = back_to_front.size();
  order_.upload(GL_R32UI, std::as_bytes(back_to_front), GL_STREAM_DRAW);
}

void GlSplats::draw(const Camera& camera, const SplatDrawOptions& options) {
  const GLenum formats[] = {GL_RGBA32F, GL_RGBA32F, GL_RGBA32F};
  float_target_.resize(camera.width_px, camera.height_px, formats);
  float_target_.bind();
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  if (ordered_ == 0) return;
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  const GlProgram& p = splat_program_;
  p.use();
  p.set("order", 0);
  p.set("geometry", 1);
  p.set("colours", 2);
  p.set("styles", 3);
  order_.bind(0);
  cloud_->geometry.bind(1);
  cloud_->colours.bind(2);
  styles_.bind(3);
  p.set("sh_degree", cloud_->sh_degree);
  p.set("sh_texels", cloud_->sh_texels);
  p.set("camera_from_world_rotation", camera.camera_from_world_rotation);
  p.set("camera_from_world_translation", camera.camera_from_world_translation);
  p.set("eye_world", camera.centre_world());
  p.set("focal_px", glm::vec2(camera.fx_px, camera.fy_px));
  p.set("principal_px", glm::vec2(camera.cx_px, camera.cy_px));
  p.set("size_px", glm::vec2(camera.width_px, camera.height_px));
  p.set("near_plane", options.near_plane);
  p.set("far_plane", options.far_plane);
  p.set("low_pass_px2", options.low_pass_px2);
  p.set("antialiased", cloud_->antialiased ? 1 : 0);
  glBindVertexArray(vertex_array_.id());
  for (std::size_t first = 0; first < ordered_; first += kBatch) {
    const auto count = static_cast<GLsizei>(6 * std::min<std::size_t>(kBatch, ordered_ - first));
    glDrawElementsBaseVertex(GL_TRIANGLES, count, GL_UNSIGNED_SHORT, nullptr, static_cast<GLint>(4 * first));
  }
}

void GlSplats::resolve(const ResolveOptions& options) {
  const GLenum formats[] = {GL_RGBA8};
  resolved_.resize(float_target_.width(), float_target_.height(), formats);
  resolved_.bind();
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  const GlProgram& p = resolve_program_;
  p.use();
  for (int unit = 0; unit < 3; ++unit) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, float_target_.texture(unit));
  }
  p.set("picture", 0);
  p.set("selected", 1);
  p.set("marked", 2);
  p.set("background", options.background);
  p.set("checker_px", options.checker_px);
  p.set("tint_strength", options.tint_strength);
  p.set("tint_shaded", options.tint_shaded ? 1 : 0);
  p.set("outline_strength", options.outline_strength);
  p.set("highlighted", options.highlighted ? 1 : 0);
  p.set("highlight_colour", options.highlight_colour);
  glBindVertexArray(vertex_array_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

Image<glm::vec4> GlSplats::read_picture() const {
  float_target_.bind();
  return read_back_rgba32f(float_target_.width(), float_target_.height());
}

}  // namespace splatcut
