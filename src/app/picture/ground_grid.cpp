#include "app/picture/ground_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace splatcut {

namespace {

constexpr float kBelowShare = 0.02f;       // floaters under the ground
constexpr float kFewestCells = 8;          // across it; rounding makes them 20 at most
constexpr float kStepPx = 4;               // between questions to the depth
constexpr int kStepsAPiece = 6;            // which has one opacity
constexpr float kRoughCells = 0.15f;       // of the scene's cell: no ground is level
constexpr float kRoughCellsAlone = 0.03f;  // there is no ground, and the thing hides what is behind it

struct Line {
  glm::vec3 from_world, to_world;
  std::optional<int> axis;
};

std::vector<Line> lines_of(const GroundGrid& grid) {
  std::vector<Line> lines;
  const glm::vec2 first(grid.first), last(grid.last);
  const auto axis_if = [](int line, int axis) { return line == 0 ? std::optional(axis) : std::nullopt; };
  for (int i = grid.first.x; i <= grid.last.x; ++i) {
    const auto at = static_cast<float>(i);
    lines.push_back({grid.point_world(at, first.y), grid.point_world(at, last.y), axis_if(i, grid.axis[1])});
  }
  for (int j = grid.first.y; j <= grid.last.y; ++j) {
    const auto at = static_cast<float>(j);
    lines.push_back({grid.point_world(first.x, at), grid.point_world(last.x, at), axis_if(j, grid.axis[0])});
  }
  return lines;
}

// Cuts [0, 1] to where from + t (to - from) >= 0. False where nothing is left.
bool clip(float from, float to, float* t0, float* t1) {
  if (from < 0 && to < 0) return false;
  if (from < 0) *t0 = std::max(*t0, from / (from - to));
  if (to < 0) *t1 = std::min(*t1, from / (from - to));
  return *t0 < *t1;
}

// What of the segment, camera frame, lies within the view frustum.
bool clip_to_view(const Camera& camera, const DrawLimits& limits, glm::vec3* a, glm::vec3* b) {
  const auto sides = [&](const glm::vec3& p) {
    const float u = camera.fx_px * p.x + camera.cx_px * p.z, v = camera.fy_px * p.y + camera.cy_px * p.z;
    return std::array<float, 6>{p.z - limits.near_plane,
                                limits.far_plane - p.z,
                                u,
                                static_cast<float>(camera.width_px) * p.z - u,
                                v,
                                static_cast<float>(camera.height_px) * p.z - v};
  };
  const auto of_a = sides(*a), of_b = sides(*b);
  float t0 = 0, t1 = 1;
  for (std::size_t i = 0; i < of_a.size(); ++i)
    if (!clip(of_a[i], of_b[i], &t0, &t1)) return false;
  const glm::vec3 from = glm::mix(*a, *b, t0), to = glm::mix(*a, *b, t1);
  *a = from;
  *b = to;
  return true;
}

// 1 in the middle of the grid, 0 at its border; and 0 where its lines run together at the horizon.
float opacity_at(const GroundGrid& grid, const Camera& camera, const glm::vec3& at_world,
                 const glm::vec3& at_camera) {
  constexpr float kFadesFrom = 0.5f, kTooClosePx = 3, kApartPx = 12;
  const glm::vec2 middle = 0.5f * (glm::vec2(grid.first) + glm::vec2(grid.last));
  const glm::vec2 half = 0.5f * glm::vec2(grid.last - grid.first);
  const glm::vec3 from_origin = at_world - grid.origin_world;
  const glm::vec2 at_cells(glm::dot(from_origin, grid.along_world[0]) / grid.cell,
                           glm::dot(from_origin, grid.along_world[1]) / grid.cell);
  const float away = glm::length((at_cells - middle) / half);
  const glm::vec3 up_camera = camera.camera_from_world_rotation * grid.up_world;
  const float steepness = std::abs(glm::dot(up_camera, glm::normalize(at_camera)));
  const float gap_px = grid.cell * camera.fy_px / at_camera.z * steepness;
  return (1 - glm::smoothstep(kFadesFrom, 1.0f, away)) * glm::smoothstep(kTooClosePx, kApartPx, gap_px);
}

bool hidden(const GroundGrid& grid, const PictureDepth& depth, const glm::vec3& at_world) {
  const auto surface = depth.before(at_world);
  return surface && std::abs(glm::dot(*surface - grid.origin_world, grid.up_world)) > grid.rough;
}

void add_pieces(const GroundGrid& grid, const Line& line, const Camera& camera, const DrawLimits& limits,
                const PictureDepth& depth, std::vector<GridPiece>* pieces) {
  glm::vec3 a = camera.camera_from_world(line.from_world), b = camera.camera_from_world(line.to_world);
  if (!clip_to_view(camera, limits, &a, &b)) return;
  const glm::vec2 a_px = camera.pixel_from_camera(a), b_px = camera.pixel_from_camera(b);
  const int steps = std::max(1, static_cast<int>(std::ceil(glm::distance(a_px, b_px) / kStepPx)));
  const glm::mat3 world_from_camera = glm::transpose(camera.camera_from_world_rotation);
  const glm::vec3 eye_world = camera.centre_world();
  const auto camera_at = [&](float s) {  // 1 / z is linear along the line in the picture
    const float t = s * a.z / (s * a.z + (1 - s) * b.z);
    return glm::mix(a, b, t);
  };
  const auto count = static_cast<float>(steps);
  int from = -1;  // of the piece that is open
  const auto close = [&](int to) {
    if (from < 0) return;
    const float s0 = static_cast<float>(from) / count, s1 = static_cast<float>(to) / count;
    const glm::vec3 middle_camera = camera_at(0.5f * (s0 + s1));
    const glm::vec3 middle_world = world_from_camera * middle_camera + eye_world;
    const float opacity = opacity_at(grid, camera, middle_world, middle_camera);
    constexpr float kLeast = 0.02f;
    if (opacity > kLeast)
      pieces->push_back({glm::mix(a_px, b_px, s0), glm::mix(a_px, b_px, s1), opacity, line.axis});
    from = -1;
  };
  for (int i = 0; i < steps; ++i) {
    const glm::vec3 at_camera = camera_at((static_cast<float>(i) + 0.5f) / count);
    const bool shows = !hidden(grid, depth, world_from_camera * at_camera + eye_world);
    if (!shows || (from >= 0 && i - from == kStepsAPiece)) close(i);
    if (shows && from < 0) from = i;
  }
  close(steps);
}

}  // namespace

float round_length_below(float length) {
  const float power = std::pow(10.0f, std::floor(std::log10(length)));
  for (const float times : {10.0f, 5.0f, 2.0f})
    if (times * power <= length * (1 + 1e-5f)) return times * power;
  return power;
}

namespace {

// From a height downwards as long as there is about as much as in what stands on the ground: the feet of a
// thing that stands alone lie below nearly all of it, as floaters do, but these are few.
float foot_below(float low, float high, const std::vector<float>& heights) {
  constexpr int kSlices = 50, kMostBelow = 15;  // of the way from low to high; how many of them at most
  constexpr float kLeastShare = 0.002f;         // of all, in a slice
  const float slice = (high - low) / kSlices;
  if (!(slice > 0)) return low;
  std::vector<std::size_t> counts(kMostBelow, 0);
  std::vector<float> lowest(kMostBelow, low);
  for (const float h : heights) {
    const float below = (low - h) / slice;
    if (!(below > 0 && below < kMostBelow)) continue;
    const auto i = static_cast<std::size_t>(below);
    ++counts[i];
    lowest[i] = std::min(lowest[i], h);
  }
  float foot = low;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (static_cast<float>(counts[i]) < kLeastShare * static_cast<float>(heights.size())) break;
    foot = lowest[i];
  }
  return foot;
}

}  // namespace

float ground_height(const GaussianCloud& cloud, const Box& bounds, const glm::vec3& up_world) {
  constexpr std::size_t kSample = 1 << 16;
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSample);
  const float middle = glm::dot(bounds.centre(), up_world);
  const auto within = [&](const glm::vec3& p) {
    return glm::all(glm::greaterThanEqual(p, bounds.min)) && glm::all(glm::lessThanEqual(p, bounds.max));
  };
  std::vector<float> heights, below_too;
  for (std::size_t g = 0; g < cloud.size(); g += step) {
    const glm::vec3& p = cloud.position[g];
    const float height = glm::dot(p, up_world);
    if (within(p)) heights.push_back(height);
    if (within(p + (middle - height) * up_world)) below_too.push_back(height);
  }
  if (heights.empty()) return glm::dot(bounds.centre(), up_world);
  const auto low =
      heights.begin() + static_cast<std::ptrdiff_t>(kBelowShare * static_cast<float>(heights.size() - 1));
  std::ranges::nth_element(heights, low);
  return foot_below(*low, std::ranges::max(heights), below_too);
}

GroundGrid ground_grid(const GaussianCloud& cloud, const Box& bounds, const glm::vec3& up_world) {
  GroundGrid grid;
  grid.up_world = up_world;
  grid.origin_world = ground_height(cloud, bounds, up_world) * up_world;
  const glm::vec3 slope = glm::abs(up_world);  // of each axis of the world
  const int upright = slope.x > slope.y && slope.x > slope.z ? 0 : slope.y > slope.z ? 1 : 2;
  grid.axis[0] = upright == 0 ? 1 : 0;
  grid.axis[1] = upright == 2 ? 1 : 2;
  glm::vec3 level(0);
  level[grid.axis[0]] = 1;
  grid.along_world[0] = glm::normalize(level - glm::dot(level, up_world) * up_world);
  glm::vec3 other(0);
  other[grid.axis[1]] = 1;
  const glm::vec3 across = glm::cross(up_world, grid.along_world[0]);
  grid.along_world[1] = glm::dot(across, other) < 0 ? -across : across;

  const glm::vec3 half = 0.5f * bounds.extent();
  glm::vec2 reach(0);  // of the box along the grid's directions
  for (int i = 0; i < 2; ++i) reach[i] = glm::dot(glm::abs(grid.along_world[i]), half);
  // What is higher than half its width is a thing that stands alone: wide enough to show around it, as the
  // grid's outer half fades.
  const float height = 2 * glm::dot(glm::abs(up_world), half);
  const float across_box = 2 * std::max({reach.x, reach.y, 1e-12f});
  const bool alone = height > 0.5f * across_box;
  const float across_scene = alone ? 2 * std::max(across_box, height) : across_box;
  grid.cell = round_length_below(across_scene / kFewestCells);
  grid.rough = (alone ? kRoughCellsAlone : kRoughCells) * grid.cell;
  const glm::vec3 from_origin = bounds.centre() - grid.origin_world;
  // That wide both ways, and a cell beyond.
  const int cells = static_cast<int>(std::ceil(0.5f * across_scene / grid.cell)) + 1;
  for (int i = 0; i < 2; ++i) {
    const int middle = static_cast<int>(std::lround(glm::dot(from_origin, grid.along_world[i]) / grid.cell));
    grid.first[i] = middle - cells;
    grid.last[i] = middle + cells;
  }
  return grid;
}

GroundGrid as_seen_by(const GroundGrid& of_scene, const Camera& camera) {
  constexpr float kCellsHigh = 2, kLeastCell = 0.01f;  // of the scene's cell
  constexpr int kCells = 12;                           // to each side
  const glm::vec3 eye = camera.centre_world() - of_scene.origin_world;
  const float height = std::abs(glm::dot(eye, of_scene.up_world));
  const float cell = round_length_below(std::max(height / kCellsHigh, kLeastCell * of_scene.cell));
  if (cell >= of_scene.cell) return of_scene;
  GroundGrid grid = of_scene;
  grid.cell = cell;
  // Half a grid's width ahead of the foot, so that most of it shows.
  const glm::vec3 forward = camera.forward_world();
  const glm::vec3 level = forward - glm::dot(forward, grid.up_world) * grid.up_world;
  const glm::vec3 middle = eye / cell + 0.5f * kCells * level;
  for (int i = 0; i < 2; ++i) {
    const int at = static_cast<int>(std::lround(glm::dot(middle, grid.along_world[i])));
    grid.first[i] = at - kCells;
    grid.last[i] = at + kCells;
  }
  return grid;
}

std::vector<GridPiece> pieces_in_view(const GroundGrid& grid, const Camera& camera, const DrawLimits& limits,
                                      const PictureDepth& depth) {
  std::vector<GridPiece> pieces;
  for (const Line& line : lines_of(grid)) add_pieces(grid, line, camera, limits, depth, &pieces);
  return pieces;
}

}  // namespace splatcut
