#include "app/document/scene_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace splatcut {

namespace {

glm::quat rotation_of(const ScenePlace& place) {
  const glm::vec3 angles = glm::radians(place.turn_deg);
  return glm::angleAxis(angles.z, glm::vec3(0, 0, 1)) * glm::angleAxis(angles.y, glm::vec3(0, 1, 0)) *
         glm::angleAxis(angles.x, glm::vec3(1, 0, 0));
}

// The angles of ScenePlace, degrees, that make this rotation. Where y is 90 or -90 only the sum (or the
// difference) of the two others counts: z is 0 then. x is measured after z and y are taken back, so that all
// three together are the rotation also near there.
glm::vec3 angles_deg(const glm::quat& rotation) {
  constexpr double kUpended = 2e-6;  // cosine of y; what the rounding of a product of rotations leaves of 0
  const glm::dmat3 m = glm::mat3_cast(glm::normalize(glm::dquat(rotation)));  // m[column][row]
  const double z = std::hypot(m[0][0], m[0][1]) < kUpended ? 0 : std::atan2(m[0][1], m[0][0]);
  const double c = std::cos(z), s = std::sin(z);
  const double y = std::atan2(-m[0][2], c * m[0][0] + s * m[0][1]);
  const double x = std::atan2(s * m[2][0] - c * m[2][1], c * m[1][1] - s * m[1][0]);
  return glm::degrees(glm::dvec3(x, y, z));
}

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

constexpr float kLeastScale = 1e-3f, kMostScale = 1e3f;  // that handles and Fit reach; numbers go further

Box seen_box(const SceneSource& file) {
  return glm::length(file.solid.extent()) > 0 ? file.solid : file.bounds;
}

// A thing to be put into the scene, not one to stand beside it.
bool is_small(const SceneSource& file, const SceneSource& first) {
  constexpr float kSmall = 0.4f;
  return file.place.scale * glm::length(seen_box(file).extent()) <
         kSmall * first.place.scale * glm::length(seen_box(first).extent());
}

}  // namespace

float half_extent(const SceneSource& file, const glm::vec3& direction_world) {
  const Similarity to = similarity_of(file);
  const glm::vec3 in_file = glm::conjugate(to.rotation) * direction_world;
  return 0.5f * to.scale * glm::dot(glm::abs(in_file), seen_box(file).extent());
}

glm::vec3 foot_world(const SceneSource& file, const glm::vec3& up_world) {
  const glm::vec3 up = glm::normalize(up_world);
  return moved(seen_box(file).centre(), similarity_of(file)) - half_extent(file, up) * up;
}

StandsOn beside(std::span<const SceneSource> files, const glm::vec3& row_world, const glm::vec3& up_world) {
  const glm::vec3 foot = foot_world(files.front(), up_world);
  float end = half_extent(files.front(), row_world);  // from that foot
  for (const SceneSource& file : files.subspan(1))
    end =
        std::max(end, glm::dot(foot_world(file, up_world) - foot, row_world) + half_extent(file, row_world));
  return {foot + end * row_world, up_world, row_world, true};
}

void stand(std::vector<SceneSource>* files) {
  constexpr float kGap = 0.2f;  // between two of the row, over half of the width of the second
  std::vector<std::pair<SceneSource*, float>> row;  // with where its middle is along it
  float along = 0;
  for (SceneSource& file : *files) {
    if (!file.onto) continue;
    if (const auto& point = file.onto->small_on_world; point && is_small(file, files->front()))
      file.onto = StandsOn{*point, file.onto->up_world};
    const auto& [point_world, up_world, row_world, begins_there, small_on_world] = *file.onto;
    file.place = stood_on(file, stood_upright(file, file.place, up_world), point_world, up_world);
    if (row_world == glm::vec3(0)) continue;
    const float half = half_extent(file, row_world);
    if (begins_there || !row.empty()) along += kGap * half;
    row.emplace_back(&file, along + half);
    along += 2 * half;
  }
  for (const auto& [file, middle] : row)
    file->place.move += (file->onto->begins_there ? middle : middle - 0.5f * along) * file->onto->row_world;
  for (SceneSource& file : *files) file.onto.reset();
}

void check(const ScenePlace& place, const std::filesystem::path& file) {
  constexpr float kLeast = 1e-6f, kMost = 1e6f, kFarthest = 1e9f;
  if (!(place.scale >= kLeast && place.scale <= kMost))
    throw Error(file.filename().string(), fmt::format("it cannot be placed {:g} times as large: {:g} to {:g}",
                                                      place.scale, kLeast, kMost));
  if (!finite(place.turn_deg)) throw Error(file.filename().string(), "the turn must be ordinary numbers");
  if (!finite(place.move) || !(glm::length(place.move) < kFarthest))
    throw Error(file.filename().string(), fmt::format("it cannot be moved by more than {:g}", kFarthest));
}

Similarity similarity_of(const SceneSource& file) {
  const glm::vec3 middle = file.bounds.centre();
  return {rotation_of(file.place), file.place.scale, middle, middle + file.place.move};
}

Similarity similarity_between(const SceneSource& before, const SceneSource& after) {
  const Similarity from = similarity_of(before), to = similarity_of(after);
  return {to.rotation * glm::conjugate(from.rotation), to.scale / from.scale, from.move, to.move};
}

ScenePlace changed(const SceneSource& file, ScenePlace place, const PlacingChange& change,
                   const glm::vec3& up_world) {
  place.move += change.move_world;
  if (change.angle_rad != 0)  // angles that say the same would be others
    place.turn_deg = angles_deg(change.turn * rotation_of(place));
  if (change.scale == 1) return place;
  return scaled_on_foot(file, place, glm::clamp(place.scale * change.scale, kLeastScale, kMostScale),
                        up_world);
}

ScenePlace stood_upright(const SceneSource& file, ScenePlace place, const glm::vec3& up_world) {
  place.turn_deg = angles_deg(turn_between(file.views->up_world, up_world));
  return place;
}

std::string why_upright(const SceneSource& file, const ScenePlace& place, const glm::vec3& up_world) {
  constexpr float kUpright = 0.99999f;  // a quarter of a degree
  const float cosine =
      glm::dot(rotation_of(place) * glm::normalize(file.views->up_world), glm::normalize(up_world));
  if (cosine < kUpright) return {};
  return file.views->up_is_guess
             ? "It stands upright already, as far as can be guessed: its file does not say which way is up. "
               "Turn it by the numbers, or by the handles in the picture"
             : "It stands upright already";
}

ScenePlace stood_on(SceneSource file, const ScenePlace& place, const glm::vec3& point_world,
                    const glm::vec3& up_world) {
  file.place = place;
  file.place.move += point_world - foot_world(file, up_world);
  return file.place;
}

ScenePlace scaled_on_foot(SceneSource file, const ScenePlace& place, float scale, const glm::vec3& up_world) {
  file.place = place;
  const glm::vec3 foot = foot_world(file, up_world);
  ScenePlace larger = place;
  larger.scale = scale;
  return stood_on(file, larger, foot, up_world);
}

float share_of_picture(const SceneSource& file, const Camera& camera, const glm::vec3& up_world) {
  const glm::vec3 sides = seen_box(file).extent();
  const float distance = glm::distance(camera.centre_world(), foot_world(file, up_world));
  const float shown = distance * static_cast<float>(camera.height_px) / camera.fy_px;
  return file.place.scale * std::max({sides.x, sides.y, sides.z}) / std::max(shown, 1e-12f);
}

ScenePlace fitted(const SceneSource& file, const Camera& camera, const glm::vec3& up_world) {
  constexpr float kFitted = 0.5f;
  const float scale = file.place.scale * kFitted / share_of_picture(file, camera, up_world);
  return scaled_on_foot(file, file.place, std::clamp(scale, kLeastScale, kMostScale), up_world);
}

std::string misfit(const SceneSource& file, const Camera& camera, const glm::vec3& up_world) {
  constexpr float kTooLarge = 2, kTooSmall = 0.125f;  // four times what Fit makes it, and a quarter
  const std::string name = file.path.filename().string();
  const Similarity to = similarity_of(file);
  const glm::vec3 eye =
      glm::conjugate(to.rotation) * (camera.centre_world() - to.move) / to.scale + to.origin;
  const Box box = seen_box(file);
  if (glm::all(glm::greaterThan(eye, box.min)) && glm::all(glm::lessThan(eye, box.max)))
    return fmt::format("You look from inside {}: Fit, under Files, makes it small enough to see", name);
  const float share = share_of_picture(file, camera, up_world);
  if (share > kTooLarge)
    return fmt::format("{} is {:.1f} times as large as what you look at: Fit, under Files, makes it smaller",
                       name, share);
  if (share < kTooSmall)
    return fmt::format("{} fills {:.2g} % of the picture's height: Fit, under Files, makes it larger", name,
                       100 * share);
  return {};
}

// The centre moves along; the picture stays the same as all depths grow by the scale.
Camera moved(const Camera& camera, const Similarity& to) {
  Camera out = camera;
  out.name.clear();
  out.camera_from_world_rotation =
      camera.camera_from_world_rotation * glm::transpose(glm::mat3_cast(to.rotation));
  out.camera_from_world_translation = -(out.camera_from_world_rotation * moved(camera.centre_world(), to));
  return out;
}

}  // namespace splatcut
