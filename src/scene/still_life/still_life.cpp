#include "scene/still_life/still_life.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/counter_rng.h"
#include "core/error.h"
#include "core/spoken_list.h"
#include "scene/cloud/quantise.h"
#include "scene/raster/rasterizer.h"
#include "scene/still_life/still_life_model.h"

namespace splatcut {
namespace {

using namespace still_life;

constexpr float kThinness = 0.10f;  // normal axis of a disc, as a part of its smaller tangent axis
// Parts of the count that the options take from the surfaces.
constexpr double kFloaterPart = 0.003, kStraddlingPart = 0.006, kInteriorPart = 0.05, kSkirtPart = 0.006;
// Streams of random numbers beyond the patches' own, which start at 0.
constexpr std::uint64_t kAppearanceStream = 1ull << 32, kExtraStream = 2ull << 32,
                        kShuffleStream = 3ull << 32;
constexpr int kCameras = 24;

struct Writer {
  LabelledScene& scene;
  std::size_t next = 0;

  // The row's own values; colour is what a viewer along no particular direction sees.
  void put(const glm::vec3& position, const glm::vec3& scale, const glm::quat& rotation, float opacity,
           const glm::vec3& colour, std::uint8_t label) {
    GaussianCloud& c = scene.cloud;
    c.position[next] = position;
    c.scale[next] = scale;
    c.rotation[next] = glm::normalize(rotation);
    c.opacity[next] = opacity;
    c.f_dc[next] = f_dc_from_colour(colour);
    scene.label[next] = label;
    ++next;
  }
};

// The SH basis of degree 1 and 2 with the signs of 3DGS (Kerbl et al. 2023).
std::array<float, 8> sh_basis(const glm::vec3& d) {
  const float x = d.x, y = d.y, z = d.z;
  return {-0.48860251f * y,    0.48860251f * z,
          -0.48860251f * x,    1.0925485f * x * y,
          -1.0925485f * y * z, 0.31539157f * (2 * z * z - x * x - y * y),
          -1.0925485f * x * z, 0.54627422f * (x * x - y * y)};
}

// A lobe around the direction from which the highlight is seen. Sum over m of basis(a) basis(b) is
// (2l+1)/(4 pi) P_l(a.b), so these coefficients give strength * (P_1 + 0.5 P_2) of the angle to it.
void put_highlight(GaussianCloud& cloud, std::size_t g, const glm::vec3& mirror, float strength) {
  const std::array<float, 8> basis = sh_basis(-mirror);  // view directions run from camera to Gaussian
  const std::size_t per_channel = cloud.sh_stride() / 3;
  const std::size_t used = std::min(per_channel, basis.size());  // degree 3 adds nothing to so soft a lobe
  for (std::size_t k = 0; k < used; ++k) {
    const float band = k < 3 ? 2 * kTau / 3 : 0.5f * 2 * kTau / 5;
    for (std::size_t channel = 0; channel < 3; ++channel)
      cloud.sh_rest[g * cloud.sh_stride() + channel * per_channel + k] = strength * band * basis[k];
  }
}

void put_patch(Writer& out, const Model& model, std::size_t index, std::size_t n, std::uint64_t seed,
               const Job& job) {
  const Patch& patch = model.patches[index];
  CounterRng rng(seed, kAppearanceStream + index);
  for (const SurfaceSample& s : sample_patch(patch.shape, n, seed, index, job)) {
    if (job.cancelled()) return;
    const Material m = patch.material(s);
    const Lit light = lit(model, s, m, patch.label);
    const glm::quat rotation = glm::quat_cast(glm::mat3(s.tangent_u, s.tangent_v, s.normal));
    const float thin = kThinness * std::min(s.sigma_u, s.sigma_v);
    const float opacity = std::min(0.995f, m.opacity + rng.between(-0.05f, 0.03f));
    const glm::vec3 colour = light.colour * rng.between(0.975f, 1.025f);
    put_highlight(out.scene.cloud, out.next, light.mirror, m.gloss * (1 - m.glow));
    out.put(s.position, {s.sigma_u, s.sigma_v, thin}, rotation, opacity, colour, patch.label);
  }
}

glm::quat random_rotation(CounterRng& rng) {
  const glm::vec3 axis = rng.in_ball() + glm::vec3(0, 1e-3f, 0);
  return glm::angleAxis(rng.between(0, kTau), glm::normalize(axis));
}

void put_floaters(Writer& out, std::size_t n, std::uint64_t seed) {
  CounterRng rng(seed, kExtraStream);
  for (std::size_t k = 0; k < n; ++k) {
    const glm::vec3 position = at(0, 0.9f, 0) + glm::vec3(1.9f, 0.8f, 1.9f) * rng.in_ball();
    const float size = 0.02f + 0.08f * rng.unit() * rng.unit();
    const glm::vec3 scale =
        size * glm::vec3(rng.between(0.4f, 1.6f), rng.between(0.4f, 1.6f), rng.between(0.2f, 0.6f));
    const glm::vec3 colour = glm::vec3(rng.between(0.55f, 0.8f)) * glm::vec3(0.98f, 1.0f, 0.99f);
    out.put(position, scale, random_rotation(rng), rng.between(0.02f, 0.25f), colour, 0);
  }
}

// Large splats centred on the line where two objects meet, labelled in turn as one and the other.
void put_straddling(Writer& out, const Model& model, std::size_t n, std::uint64_t seed) {
  CounterRng rng(seed, kExtraStream + 1);
  for (std::size_t k = 0; k < n; ++k) {
    const Contact& contact = model.contacts[rng.below(model.contacts.size())];
    const float angle = rng.between(0, kTau);
    const glm::vec3 out_dir{std::cos(angle), 0, std::sin(angle)};
    const glm::vec3 position =
        contact.centre + contact.radius * out_dir + at(0, rng.between(0.0f, 0.012f), 0);
    const glm::vec3 scale{rng.between(0.03f, 0.06f), rng.between(0.012f, 0.03f), 0.006f};
    const std::uint8_t label = k % 2 == 0 ? contact.label : contact.other;
    const glm::quat rotation = glm::angleAxis(-angle, glm::vec3(0, 1, 0)) *
                               glm::angleAxis(rng.between(-0.9f, 0.9f), glm::vec3(0, 0, 1));
    out.put(position, scale, rotation, rng.between(0.3f, 0.8f), 0.8f * contact.colour, label);
  }
}

// The margin of an object that training left under what it stands on: seen once that is gone.
void put_skirts(Writer& out, const Model& model, std::size_t n, std::uint64_t seed) {
  CounterRng rng(seed, kExtraStream + 3);
  for (std::size_t k = 0; k < n; ++k) {
    const Contact& contact = model.contacts[rng.below(model.contacts.size())];
    const float angle = rng.between(0, kTau);
    const glm::vec3 out_dir{std::cos(angle), 0, std::sin(angle)};
    const glm::vec3 position = contact.centre + rng.between(0.95f, 1.12f) * contact.radius * out_dir -
                               at(0, rng.between(0.012f, 0.03f), 0);
    const glm::vec3 scale{rng.between(0.02f, 0.04f), 0.003f, rng.between(0.01f, 0.02f)};
    out.put(position, scale, glm::angleAxis(-angle, glm::vec3(0, 1, 0)), rng.between(0.3f, 0.8f),
            0.5f * contact.colour, contact.label);
  }
}

// No camera constrains what is inside: any colour, any opacity.
void put_interior(Writer& out, const Model& model, std::size_t n, std::uint64_t seed) {
  CounterRng rng(seed, kExtraStream + 2);
  for (std::size_t k = 0; k < n; ++k) {
    const Proxy& ball = model.interiors[rng.below(model.interiors.size())];
    const glm::vec3 position = ball.centre + 0.85f * ball.radius * rng.in_ball();
    const glm::vec3 scale =
        0.12f * ball.radius * glm::vec3(rng.between(0.3f, 1), rng.between(0.3f, 1), rng.between(0.3f, 1));
    const glm::vec3 colour{rng.between(0.05f, 0.8f), rng.between(0.05f, 0.8f), rng.between(0.05f, 0.8f)};
    out.put(position, scale, random_rotation(rng), rng.between(0.05f, 0.9f), colour, ball.label);
  }
}

std::size_t part(bool on, double fraction, std::size_t total) {
  return on ? static_cast<std::size_t>(fraction * static_cast<double>(total)) : 0;
}

Model still_life_model(const StillLifeOptions& options) {
  Model model;
  model.add_label("background");
  add_room(model, options);
  add_mug(model, options);
  add_fruit(model, options);
  add_plant(model, options);
  add_books(model, options);
  add_lamp(model, options);
  add_twin(model, options);
  add_occluder(model, options);
  return model;
}

// Splats per patch: area times detail; where the count is small, an object left with none takes one from
// the patch that has most.
std::vector<std::size_t> patch_counts(const Model& model, std::size_t total) {
  std::vector<double> weights;
  for (const Patch& patch : model.patches)
    weights.push_back(static_cast<double>(patch_area(patch.shape)) * static_cast<double>(patch.detail));
  std::vector<std::size_t> counts = apportioned(weights, total);
  for (std::size_t label = 0; label < model.label_name.size(); ++label) {
    std::size_t of_label = 0, first = counts.size();
    for (std::size_t i = counts.size(); i-- > 0;)
      if (model.patches[i].label == label) of_label += counts[i], first = i;
    const auto most = std::max_element(counts.begin(), counts.end());
    if (of_label > 0 || *most < 2) continue;
    --*most;
    ++counts[first];
  }
  return counts;
}

// Rows with a 0 leave.
void keep_rows(LabelledScene& scene, const std::vector<std::uint8_t>& keep) {
  std::vector<std::uint32_t> stay;
  for (std::uint32_t g = 0; g < keep.size(); ++g)
    if (keep[g]) stay.push_back(g);
  const float near_plane = scene.cloud.near_plane;
  scene.cloud = permuted(scene.cloud, stay);
  scene.cloud.near_plane = near_plane;
  for (std::vector<std::uint8_t>* values : {&scene.label, &scene.own}) {
    std::vector<std::uint8_t> kept;
    for (const std::uint32_t g : stay) kept.push_back((*values)[g]);
    *values = std::move(kept);
  }
  std::iota(scene.cloud.file_row.begin(), scene.cloud.file_row.end(), 0u);
}

// 1 for what is worth half a pixel in all cameras together, half as wide.
std::vector<std::uint8_t> seen(const LabelledScene& scene, const Job& job) {
  constexpr double kLeastPx = 0.5;
  PlaneSums sums(scene.cloud.size(), 1);
  for (const Camera& camera : scene.cameras) {
    const Camera small = limited_to_width(camera, camera.width_px / 2);
    const std::vector<Image<float>> one(1, Image<float>(small.width_px, small.height_px, 1));
    RasterOptions raster;
    raster.colour = false;
    raster.sum_planes = one;
    raster.plane_sums = &sums;
    rasterize(scene.cloud, small, raster, job);
  }
  std::vector<std::uint8_t> seen(scene.cloud.size());
  for (std::size_t g = 0; g < seen.size(); ++g) seen[g] = sums.at(g, 0) >= kLeastPx;
  return seen;
}

std::uint8_t label_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.begin() || found == names.end())
    throw Error("still life", "there is no object \"" + name + "\"",
                "There are " + spoken_list(std::span(names).subspan(1), "and"));
  return static_cast<std::uint8_t>(found - names.begin());
}

void shuffle_rows(LabelledScene& scene, std::uint64_t seed) {
  std::vector<std::uint32_t> order(scene.cloud.size());
  std::iota(order.begin(), order.end(), 0u);
  CounterRng rng(seed, kShuffleStream);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng.below(i)]);
  scene.cloud = permuted(scene.cloud, order);
  scene.cloud.near_plane = natural_near_plane(scene.cloud.position);
  for (std::vector<std::uint8_t>* values : {&scene.label, &scene.own}) {
    std::vector<std::uint8_t> shuffled(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) shuffled[i] = (*values)[order[i]];
    *values = std::move(shuffled);
  }
  std::iota(scene.cloud.file_row.begin(), scene.cloud.file_row.end(), 0u);
}

std::vector<Camera> circle_of_cameras() {
  constexpr float kDistance = 2.85f, kFovY = 0.72f;
  constexpr std::array<float, 2> kElevation{0.40f, 0.68f};  // radians above the table
  const glm::vec3 target = at(0, 0.24f, 0);
  std::vector<Camera> cameras;
  for (int i = 0; i < kCameras; ++i) {
    const float around = kTau * (static_cast<float>(i) / kCameras - 0.25f);  // camera 0 looks along +z
    const float up = kElevation[static_cast<std::size_t>(i % 2)];
    const glm::vec3 away{std::cos(up) * std::cos(around), -std::sin(up), std::cos(up) * std::sin(around)};
    cameras.push_back(look_at(target + kDistance * away, target, {0, -1, 0}, kFovY, 1008, 756));
    cameras.back().name = "view_" + std::string(i < 10 ? "0" : "") + std::to_string(i);
  }
  return cameras;
}

void check(const StillLifeOptions& options) {
  if (options.sh_degree < 0 || options.sh_degree > 3)
    throw Error("still life", "SH degree " + std::to_string(options.sh_degree) + " is outside 0 to 3");
  if (!(options.thin_width_scale > 0 && options.thin_width_scale <= 10))
    throw Error("still life", "the width scale of thin parts must be above 0 and at most 10");
}

}  // namespace

LabelledScene make_still_life(const StillLifeOptions& options, const Job& job) {
  check(options);
  Model model = still_life_model(options);
  const std::uint8_t absent = options.without.empty() ? 0 : label_of(model.label_name, options.without);
  if (absent != 0) std::erase_if(model.proxies, [&](const Proxy& p) { return p.label == absent; });
  LabelledScene scene;
  scene.label_name = model.label_name;
  scene.cloud.resize(options.gaussians, options.sh_degree);
  scene.label.resize(options.gaussians);
  const std::size_t floaters = part(options.floaters, kFloaterPart, options.gaussians);
  const std::size_t straddling = part(options.straddling, kStraddlingPart, options.gaussians);
  const std::size_t interior = part(options.unseen_interior, kInteriorPart, options.gaussians);
  const std::size_t skirts = part(options.skirts, kSkirtPart, options.gaussians);
  const std::vector<std::size_t> counts =
      patch_counts(model, options.gaussians - floaters - straddling - interior - skirts);
  Writer out{scene};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    job.progress("making surfaces", static_cast<double>(i) / static_cast<double>(counts.size()));
    put_patch(out, model, i, counts[i], options.seed, job);
    if (job.cancelled()) return scene;
  }
  scene.own.assign(options.gaussians, 0);
  std::fill_n(scene.own.begin(), out.next, 1);
  put_floaters(out, floaters, options.seed);
  put_straddling(out, model, straddling, options.seed);
  put_interior(out, model, interior, options.seed);
  put_skirts(out, model, skirts, options.seed);
  shuffle_rows(scene, options.seed);
  if (job.cancelled()) return scene;
  scene.cameras = circle_of_cameras();
  if (absent != 0) {
    std::vector<std::uint8_t> keep;
    for (const std::uint8_t label : scene.label) keep.push_back(label != absent);
    keep_rows(scene, keep);
  }
  if (options.hidden_missing) keep_rows(scene, seen(scene, job));
  scene.seeds = seed_clicks(scene);
  return scene;
}

}  // namespace splatcut
