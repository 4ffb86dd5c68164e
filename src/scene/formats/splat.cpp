// .splat (antimatter15): 32 bytes a Gaussian: position 3 float, linear scale 3 float, colour and opacity
// 4 bytes, rotation 4 bytes w x y z as (b - 128) / 128. No header, no spherical harmonics.
#include <fmt/format.h>

#include <limits>

#include "core/atomic_file.h"
#include "core/error.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/decode.h"
#include "scene/formats/losses.h"
#include "scene/packing/incomplete.h"

namespace splatcut {

namespace {

constexpr std::size_t kRowBytes = 32;
constexpr std::size_t kScaleAt = 12, kColourAt = 24, kRotationAt = 28;

struct SplatRows {
  const std::byte* data = nullptr;

  static glm::vec3 vec3(const std::byte* at) {
    return {load<float>(at), load<float>(at + 4), load<float>(at + 8)};
  }
  static glm::quat rotation(const std::byte* row) {
    const auto component = [&](std::size_t i) { return (byte_at(row + kRotationAt + i) - 128.0f) / 128.0f; };
    return {component(0), component(1), component(2), component(3)};
  }
  glm::vec3 position(std::size_t index) const {
    const std::byte* row = data + index * kRowBytes;
    const glm::vec3 scale = vec3(row + kScaleAt);
    const glm::quat q = rotation(row);
    const bool good = is_size(scale) && glm::dot(q, q) > 0;
    return good ? vec3(row) : kDroppedRow;
  }
  void decode(std::size_t index, GaussianCloud& cloud, std::size_t g) const {
    const std::byte* row = data + index * kRowBytes;
    const std::byte* colour = row + kColourAt;
    cloud.scale[g] = vec3(row + kScaleAt);
    cloud.rotation[g] = glm::normalize(rotation(row));
    cloud.f_dc[g] =
        f_dc_from_colour(glm::vec3(byte_at(colour), byte_at(colour + 1), byte_at(colour + 2)) / 255.0f);
    cloud.opacity[g] = byte_at(colour + 3) / 255.0f;
  }
};

struct SplatRow {
  glm::vec3 position, scale;
  std::uint8_t rgba[4], rotation[4];
};
static_assert(sizeof(SplatRow) == kRowBytes);

void read_splat(const MappedFile& file, const LoadOptions&, Scene& scene, const Job& job) {
  const std::size_t size = file.bytes().size();
  const std::size_t rows = size / kRowBytes;
  if (size % kRowBytes != 0)
    throw Error(file.path().string(), incomplete(fmt::format("row {} is cut at byte {} (a row has {} bytes)",
                                                             rows, size, kRowBytes)));
  if (rows > std::numeric_limits<std::uint32_t>::max())
    throw Error(file.path().string(), fmt::format("{} Gaussians are more than can be handled", rows));
  decode_rows(SplatRows{file.bytes().data()}, rows, 0, scene, job);
}

Losses splat_losses(const Scene& scene, std::span<const std::uint32_t> gaussians, bool up_is_known) {
  constexpr float kHalfStep = 0.5f / 255;
  constexpr Reach kColours{(-kHalfStep - 0.5f) / kShC0Rounded, (0.5f + kHalfStep) / kShC0Rounded};
  Losses losses;
  if (scene.cloud.sh_degree > 0)
    losses.add(fmt::format("view-dependent colour: spherical harmonics of degree {} are dropped",
                           scene.cloud.sh_degree));
  losses.add("colours, opacities and rotations are rounded to 8 bits");
  losses.add(clamped_colours(scene.cloud, gaussians, kColours));
  losses.add(origin_left_out(scene));
  losses.add(properties_left_out(scene));
  losses.add(antialiasing_left_out(scene));
  if (up_is_known) losses.add("which way is up is left out");
  return losses;
}

std::string write_splat(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                        const SaveOptions& options) {
  const GaussianCloud& cloud = scene.cloud;
  std::vector<SplatRow> rows(gaussians.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::uint32_t g = gaussians[i];
    const glm::vec3 colour = 255.0f * colour_from_f_dc(cloud.f_dc[g]);
    const glm::quat q = cloud.rotation[g] * 128.0f;
    rows[i] = {cloud.position[g],
               never_flat(cloud.scale[g]),
               {to_byte(colour.x), to_byte(colour.y), to_byte(colour.z), to_byte(255.0f * cloud.opacity[g])},
               {to_byte(q.w + 128), to_byte(q.x + 128), to_byte(q.y + 128), to_byte(q.z + 128)}};
  }
  out.write(std::as_bytes(std::span(rows)));
  return splat_losses(scene, gaussians, options.up.has_value()).sentence();
}

FormatPlan plan_splat(const Scene& scene, std::span<const std::uint32_t> gaussians, bool) {
  FormatPlan plan;
  plan.bytes = gaussians.size() * kRowBytes;
  plan.kept = "Position and scale in full; colour, opacity and rotation in 8 bits.";
  plan.lost = splat_losses(scene, gaussians, true).in_full();
  return plan;
}

}  // namespace

constinit const SceneFormat SceneFormat::kSplat = {
    .name = "splat",
    .extension = ".splat",
    .read = read_splat,
    .write = write_splat,
    .plan = plan_splat,
};

}  // namespace splatcut
