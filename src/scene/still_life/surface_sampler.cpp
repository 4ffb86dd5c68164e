#include "scene/still_life/surface_sampler.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/counter_rng.h"

namespace splatcut {
namespace {

constexpr double kGolden = 0.61803398874989485;
constexpr float kJitter = 0.30f;      // of the lattice spacing: hides the lattice, opens no holes
constexpr float kDifference = 1e-3f;  // step of the finite differences in u and v

struct Derivatives {
  glm::vec3 du, dv;
};

Derivatives derivatives_at(const SurfaceFn& surface, float u, float v) {
  const float u0 = std::max(0.0f, u - kDifference), u1 = std::min(1.0f, u + kDifference);
  const float v0 = std::max(0.0f, v - kDifference), v1 = std::min(1.0f, v + kDifference);
  return {(surface(u1, v) - surface(u0, v)) / (u1 - u0), (surface(u, v1) - surface(u, v0)) / (v1 - v0)};
}

// Cumulative areas: per row of cells over v, and within each row over u.
struct AreaTable {
  int cells_u, cells_v;
  std::vector<float> rows;   // cells_v + 1, normalised
  std::vector<float> cells;  // cells_v * (cells_u + 1), each row normalised
  float area = 0;
};

void normalise(std::span<float> cumulative) {
  const float total = cumulative.back();
  for (std::size_t i = 0; i < cumulative.size(); ++i)
    cumulative[i] =
        total > 0 ? cumulative[i] / total : static_cast<float>(i) / static_cast<float>(cumulative.size() - 1);
}

AreaTable area_table(const PatchShape& shape) {
  AreaTable table{shape.cells_u, shape.cells_v, {0.0f}, {}, 0};
  const float du = 1.0f / static_cast<float>(shape.cells_u), dv = 1.0f / static_cast<float>(shape.cells_v);
  for (int j = 0; j < shape.cells_v; ++j) {
    const std::size_t begin = table.cells.size();
    table.cells.push_back(0);
    for (int i = 0; i < shape.cells_u; ++i) {
      const Derivatives d = derivatives_at(shape.surface, (static_cast<float>(i) + 0.5f) * du,
                                           (static_cast<float>(j) + 0.5f) * dv);
      table.cells.push_back(table.cells.back() + glm::length(glm::cross(d.du, d.dv)) * du * dv);
    }
    table.rows.push_back(table.rows.back() + table.cells.back());
    normalise(std::span(table.cells).subspan(begin));
  }
  table.area = table.rows.back();
  normalise(table.rows);
  return table;
}

struct Inverse {
  std::size_t cell;
  float value;  // [0, 1]
};

Inverse inverted(std::span<const float> cumulative, float x) {
  const auto above = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, x);
  const auto cell = static_cast<std::size_t>(above - cumulative.begin()) - 1;
  const float low = cumulative[cell], high = cumulative[cell + 1];
  const float inside = high > low ? std::clamp((x - low) / (high - low), 0.0f, 1.0f) : 0.5f;
  return {cell, (static_cast<float>(cell) + inside) / static_cast<float>(cumulative.size() - 1)};
}

glm::vec2 warped(const AreaTable& table, const glm::vec2& x) {
  const Inverse v = inverted(table.rows, x.y);
  const std::size_t stride = static_cast<std::size_t>(table.cells_u) + 1;
  return {inverted(std::span(table.cells).subspan(v.cell * stride, stride), x.x).value, v.value};
}

glm::vec3 any_orthogonal(const glm::vec3& v) {
  return std::abs(v.x) < 0.7f ? glm::cross(v, glm::vec3(1, 0, 0)) : glm::cross(v, glm::vec3(0, 1, 0));
}

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& otherwise) {
  const float length = glm::length(v);
  return length > 1e-9f ? v / length : otherwise;
}

// The frame from the derivatives; poles and tips, where one of them vanishes, get any valid frame.
void orient(SurfaceSample& s, const Derivatives& d, bool face_up) {
  s.tangent_v = unit_or(d.dv, glm::vec3(0, 1, 0));
  const glm::vec3 across = unit_or(any_orthogonal(s.tangent_v), glm::vec3(1, 0, 0));
  s.tangent_u = unit_or(d.du - s.tangent_v * glm::dot(d.du, s.tangent_v), across);
  s.normal = glm::cross(s.tangent_u, s.tangent_v);
  if (face_up && s.normal.y > 0) {
    s.normal = -s.normal;
    s.tangent_u = -s.tangent_u;
  }
}

void turn(SurfaceSample& s, float angle) {
  const glm::vec3 u = s.tangent_u, v = s.tangent_v;
  s.tangent_u = std::cos(angle) * u + std::sin(angle) * v;
  s.tangent_v = std::cos(angle) * v - std::sin(angle) * u;
}

}  // namespace

float patch_area(const PatchShape& shape) {
  return area_table(shape).area;
}

std::vector<SurfaceSample> sample_patch(const PatchShape& shape, std::size_t n, std::uint64_t seed,
                                        std::uint64_t stream, const Job& job) {
  std::vector<SurfaceSample> samples(n);
  if (n == 0) return samples;
  const AreaTable table = area_table(shape);
  const float spacing = std::sqrt(table.area / static_cast<float>(n));
  const float root = std::sqrt(shape.stretch), cell = 1.0f / std::sqrt(static_cast<float>(n));
  CounterRng rng(seed, stream);
  const double shift = rng.unit();
  for (std::size_t k = 0; k < n && !job.cancelled(); ++k) {
    SurfaceSample& s = samples[k];
    // k/n along v, k phi along u; the jitter is the same length in both.
    const double along = (static_cast<double>(k) + 0.5) / static_cast<double>(n);
    const double across = static_cast<double>(k) * kGolden + shift;
    glm::vec2 x{static_cast<float>(across - std::floor(across)), static_cast<float>(along)};
    x += kJitter * cell * glm::vec2(rng.between(-1, 1), rng.between(-1, 1));
    x.x -= std::floor(x.x);
    x.y = x.y < 0 ? -x.y : x.y > 1 ? 2 - x.y : x.y;
    s.uv = warped(table, x);
    s.position = shape.surface(s.uv.x, s.uv.y);
    const Derivatives d = derivatives_at(shape.surface, s.uv.x, s.uv.y);
    orient(s, d, shape.face_up);
    const float size = shape.overlap * spacing;
    const float floor_size = 0.05f * size;  // at poles the local width is 0: keep the splat visible
    s.sigma_u = std::clamp(size * root * rng.between(0.75f, 1.3f), 0.0f,
                           std::max(floor_size, shape.limit_u * glm::length(d.du)));
    s.sigma_v = std::clamp(size / root * rng.between(0.75f, 1.3f), 0.0f,
                           std::max(floor_size, shape.limit_v * glm::length(d.dv)));
    const float angle = rng.between(0, kTau);
    if (shape.turn_randomly) turn(s, angle);
  }
  return samples;
}

std::vector<std::size_t> apportioned(std::span<const double> weights, std::size_t total) {
  std::vector<std::size_t> parts(weights.size());
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  assert(sum > 0 || total == 0);
  if (total == 0) return parts;
  std::vector<double> remainder(weights.size());
  std::size_t given = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double exact = weights[i] / sum * static_cast<double>(total);
    parts[i] = static_cast<std::size_t>(exact);
    remainder[i] = exact - static_cast<double>(parts[i]);
    given += parts[i];
  }
  std::vector<std::size_t> order(weights.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return remainder[a] > remainder[b]; });
  for (std::size_t i = 0; given < total; i = (i + 1) % order.size(), ++given) ++parts[order[i]];
  return parts;
}

SurfaceFn parallelogram(const glm::vec3& origin, const glm::vec3& edge_u, const glm::vec3& edge_v) {
  return [=](float u, float v) { return origin + u * edge_u + v * edge_v; };
}

SurfaceFn revolution(const glm::vec3& base, std::vector<glm::vec2> profile) {
  assert(profile.size() >= 2);
  // Arc length along the profile, so that v moves at constant speed over short and long pieces.
  std::vector<float> length(profile.size(), 0.0f);
  for (std::size_t i = 1; i < profile.size(); ++i)
    length[i] = length[i - 1] + glm::length(profile[i] - profile[i - 1]);
  return [base, profile = std::move(profile), length = std::move(length)](float u, float v) {
    const float s = v * length.back();
    const auto above = std::upper_bound(length.begin() + 1, length.end() - 1, s);
    const auto i = static_cast<std::size_t>(above - length.begin());
    const float t = (s - length[i - 1]) / std::max(1e-9f, length[i] - length[i - 1]);
    const glm::vec2 rh = profile[i - 1] + t * (profile[i] - profile[i - 1]);
    return base + glm::vec3(rh.x * std::cos(kTau * u), -rh.y, rh.x * std::sin(kTau * u));
  };
}

SurfaceFn tube(std::function<glm::vec3(float)> path, std::function<float(float)> radius,
               const glm::vec3& side) {
  return [path = std::move(path), radius = std::move(radius), side](float u, float v) {
    const glm::vec3 centre = path(v);
    const glm::vec3 along = glm::normalize(path(v + kDifference) - path(v - kDifference));
    const glm::vec3 n = glm::normalize(side - along * glm::dot(side, along));
    const glm::vec3 b = glm::cross(along, n);
    return centre + radius(v) * (std::cos(kTau * u) * n + std::sin(kTau * u) * b);
  };
}

}  // namespace splatcut
