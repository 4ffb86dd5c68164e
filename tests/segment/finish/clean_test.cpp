// Clean edges: the cut Gaussian by quadrature, the guard, thin things, labels that lack a piece, and a still
// life whose true objects are known.
#include "segment/finish/clean.h"

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "app/measure/evaluate_alone.h"
#include "scene/raster/splat_math.h"
#include "segment/finish/half_gaussian.h"
#include "synthetic_cloud.h"
#include "thing_of_still_life.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

glm::dmat3 covariance(const SolidGaussian& g) {
  return glm::dmat3(covariance_world(g.scale, g.rotation));
}

// Mean and covariance of the part of a Gaussian beyond the plane that leaves `share`, summed up over a grid
// in the frame in which the Gaussian is a unit ball.
struct Moments {
  double mass = 0;
  glm::dvec3 mean{0};
  glm::dmat3 covariance{0};
};
Moments by_quadrature(const SolidGaussian& g, const glm::dvec3& normal, double tau) {
  glm::dmat3 world_from_ball = glm::mat3_cast(glm::dquat(g.rotation));
  for (int axis = 0; axis < 3; ++axis) world_from_ball[axis] *= static_cast<double>(g.scale[axis]);
  const glm::dvec3 u = glm::normalize(glm::transpose(world_from_ball) * normal);
  const glm::dvec3 v =
      glm::normalize(glm::cross(u, std::abs(u.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 w = glm::cross(u, v);
  constexpr int kCells = 90;
  constexpr double kReach = 7;
  Moments m;
  glm::dmat3 squares(0);
  const double across = (kReach - tau) / kCells, along = 2 * kReach / kCells;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j)
      for (int k = 0; k < kCells; ++k) {
        const double a = tau + (i + 0.5) * across, b = -kReach + (j + 0.5) * along,
                     c = -kReach + (k + 0.5) * along;
        const double p =
            std::exp(-0.5 * (a * a + b * b + c * c)) * across * along * along / std::pow(2 * M_PI, 1.5);
        const glm::dvec3 x = world_from_ball * (a * u + b * v + c * w);
        m.mass += p;
        m.mean += p * x;
        squares += p * glm::outerProduct(x, x);
      }
  m.mean /= m.mass;
  m.covariance = squares / m.mass - glm::outerProduct(m.mean, m.mean);
  return m;
}

double largest(const glm::dmat3& m) {
  double most = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) most = std::max(most, std::abs(m[i][j]));
  return most;
}

StillLifeOptions hard_edges(bool skirts = true) {
  StillLifeOptions options;
  options.gaussians = 20000;
  options.straddling = true;
  options.skirts = skirts;
  return options;
}

bool same_rows(const GaussianCloud& a, const GaussianCloud& b) {
  return a.position == b.position && a.scale == b.scale && a.rotation == b.rotation &&
         a.opacity == b.opacity && a.f_dc == b.f_dc && a.sh_rest == b.sh_rest && a.file_row == b.file_row;
}

}  // namespace

TEST_CASE("probit: tabled quantiles of the standard normal distribution") {
  CHECK(probit(0.5) == doctest::Approx(0).epsilon(1e-8));
  CHECK(probit(0.975) == doctest::Approx(1.959963984540).epsilon(1e-8));
  CHECK(probit(0.01) == doctest::Approx(-2.326347874041).epsilon(1e-8));
}

TEST_CASE("a covariance goes into scale and rotation and comes back") {
  const GaussianCloud cloud = random_cloud(200, 5);
  for (std::size_t g = 0; g < cloud.size(); ++g) {
    const glm::mat3 sigma = covariance_world(cloud.scale[g], cloud.rotation[g]);
    glm::vec3 scale(0);
    glm::quat rotation(1, 0, 0, 0);
    scale_and_rotation(glm::dmat3(sigma), &scale, &rotation);
    CHECK(largest(glm::dmat3(covariance_world(scale, rotation) - sigma)) < 2e-6 * largest(glm::dmat3(sigma)));
    CHECK(glm::length(rotation) == doctest::Approx(1).epsilon(1e-5));
  }
}

TEST_CASE("half a Gaussian: moments are those of the part beyond the plane, by quadrature") {
  std::mt19937 random(3);
  const auto uniform = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
  for (const double share : {0.1, 0.5, 0.8}) {
    const SolidGaussian whole{{0.3f, -0.2f, 1},
                              {0.1f + uniform(), 0.1f + uniform(), 0.1f + uniform()},
                              glm::normalize(glm::quat(uniform(), uniform(), uniform(), uniform())),
                              0.6f};
    const glm::vec3 normal(uniform() - 0.5f, uniform() - 0.5f, uniform() + 0.1f);
    const Moments m = by_quadrature(whole, glm::dvec3(normal), probit(1 - share));
    const SolidGaussian half = half_gaussian(whole, normal, share);
    CAPTURE(share);
    CHECK(m.mass == doctest::Approx(share).epsilon(1e-3));
    CHECK(glm::length(glm::dvec3(half.mean - whole.mean) - m.mean) < 2e-3);
    CHECK(largest(covariance(half) - m.covariance) < 3e-3 * largest(covariance(whole)));
    // What shows: opacity times extent across the plane is the share of what it was.
    const glm::dvec3 n(normal);
    const double before = std::sqrt(glm::dot(n, covariance(whole) * n)),
                 after = std::sqrt(glm::dot(n, covariance(half) * n));
    CHECK(static_cast<double>(half.opacity) * after == doctest::Approx(share * 0.6 * before).epsilon(1e-3));
  }
}

TEST_CASE("half a Gaussian: no extent across the plane, or nothing beyond it, changes nothing") {
  const SolidGaussian disc{{0, 0, 1}, {1, 1, 0}, {1, 0, 0, 0}, 0.5f};
  for (const SolidGaussian& half : {half_gaussian(disc, {0, 0, 1}, 0.5), half_gaussian(disc, {1, 0, 0}, 0),
                                    half_gaussian(disc, {1, 0, 0}, 1)}) {
    CHECK(half.mean == disc.mean);
    CHECK(half.scale == disc.scale);
    CHECK(half.opacity == disc.opacity);
  }
}

TEST_CASE("edges that straddle and hide: the clean object is nearer to the true one, for each thing") {
  struct Case {
    const char* name;
    bool skirts;
  };
  for (const auto& [name, skirts] : {Case{"mug", true}, Case{"orange", true}, Case{"apple", false}}) {
    const Thing thing(hard_edges(skirts), name);
    const AloneScore kept = score_alone(thing.test, thing.as_labelled());
    const CleanObject object = thing.clean();
    CAPTURE(name);
    CAPTURE(object.report.why_not);
    REQUIRE(object.report.cleaned);
    const AloneScore clean = score_alone(thing.test, object.cloud);
    CHECK(kept.alpha_error > 0.01);
    CHECK(clean.alpha_error < 0.7 * kept.alpha_error);
    CHECK(clean.halo < 0.6 * kept.halo);
    CHECK(clean.iou > kept.iou);
    CHECK(clean.psnr_magenta_db > kept.psnr_magenta_db);
    CHECK(object.report.left > 0);
    CHECK(object.cloud.size() == object.gaussian.size());
    CHECK(object.report.left + object.cloud.size() == thing.as_labelled().size());
  }
}

TEST_CASE("a lump below the table, whatever its labels, is no part of the thing on it, and its foot stays") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing thing(options, "orange");
  std::vector<std::uint32_t> rows(thing.scene.cloud.size());
  std::iota(rows.begin(), rows.end(), 0u);
  const Box orange = robust_bounds(thing.as_labelled().position, 1);
  std::vector<std::uint8_t> labels = thing.test.truth_labels;
  const auto count = static_cast<std::size_t>(std::ranges::count(labels, 1));
  for (std::uint32_t g = 0; rows.size() < labels.size() + 60; ++g)
    if (labels[g]) rows.push_back(g);
  GaussianCloud cloud = permuted(thing.scene.cloud, rows);
  const glm::vec3 below(orange.centre().x + orange.extent().x, orange.max.y + 0.7f * orange.extent().y,
                        orange.centre().z);
  for (std::size_t g = labels.size(); g < rows.size(); ++g)
    cloud.position[g] = below + 0.3f * (cloud.position[g] - orange.centre());
  labels.resize(rows.size(), 1);
  const CleanObject alone = thing.clean();
  const CleanObject object = clean_object({cloud, labels, {0, -1, 0}, thing.scene.cameras});
  REQUIRE(object.report.cleaned);
  CHECK(object.gaussian == alone.gaussian);
  CHECK(object.gaussian.size() > 0.99 * static_cast<double>(count));
}

TEST_CASE("thin things whose labels are perfect lose next to nothing") {
  StillLifeOptions options;
  options.gaussians = 20000;
  for (const char* name : {"lamp", "plant"}) {
    const Thing thing(options, name);
    const CleanObject object = thing.clean();
    CAPTURE(name);
    const AloneScore clean = score_alone(thing.test, object.cloud);
    CHECK(clean.iou > 0.99);
    CHECK(clean.missing < 0.01);
  }
}

TEST_CASE("labels that lack a piece: what is seen of the object around it stays, and skirts leave") {
  for (const char* name : {"mug", "apple", "pot"}) {
    CAPTURE(name);
    const Thing thing(hard_edges(), name);
    const std::vector<glm::vec3>& position = thing.scene.cloud.position;
    const ObjectExtent extent = object_extent(thing.scene.cloud, thing.test.truth_labels);
    const glm::vec3 from = glm::normalize(thing.scene.cameras.front().centre_world() - extent.centre_world);
    EvaluationCase lacking = thing.test;  // a ball of its front
    for (std::size_t g = 0; g < position.size(); ++g)
      if (glm::distance(position[g], extent.centre_world + 0.6f * extent.radius * from) <
          0.4f * extent.radius)
        lacking.truth_labels[g] = lacking.own_labels[g] = 0;
    render_truth(&lacking);
    const CleanObject object = thing.clean(lacking.truth_labels);
    REQUIRE(object.report.cleaned);
    CHECK(object.report.used >= 6);
    const AloneScore before = score_alone(lacking, rest_of(thing.scene.cloud, lacking.truth_labels, {})),
                     after = score_alone(lacking, object.cloud);
    MESSAGE(std::string(name), ": agreed ", object.report.agreed, ", IoU ", before.iou, " -> ", after.iou,
            ", missing ", before.missing, " -> ", after.missing);
    CHECK(after.missing < before.missing + 0.02);
    CHECK(after.iou > before.iou - 0.03);  // through the hole one sees what the scene hides
    CHECK(after.halo <= before.halo);
  }
}

TEST_CASE("thick skirts leave, by the views that agree best") {
  StillLifeOptions options = hard_edges();
  options.gaussians = 60000;
  for (const char* name : {"apple", "orange"}) {
    CAPTURE(name);
    const Thing thing(options, name);
    const CleanObject object = thing.clean();
    CHECK(object.report.cleaned);
    CHECK(object.report.agreed < 6);
    CHECK(object.report.used == 6);
    const AloneScore before = score_alone(thing.test, thing.as_labelled()),
                     after = score_alone(thing.test, object.cloud);
    MESSAGE(std::string(name), ": halo ", before.halo, " -> ", after.halo, ", IoU ", before.iou, " -> ",
            after.iou);
    CHECK(after.halo < 0.05 * before.halo);
    CHECK(after.iou > 0.99);
  }
}

TEST_CASE("what no side shows keeps its edges, which is said") {
  const Thing thing(hard_edges(), "orange");
  GaussianCloud hidden = thing.scene.cloud;  // every thing is clear as glass
  std::ranges::fill(hidden.opacity, 1e-4f);
  const CleanObject none = clean_object({hidden, thing.test.truth_labels, {0, -1, 0}, thing.scene.cameras});
  CHECK_FALSE(none.report.cleaned);
  CHECK(none.report.views == 0);
  CHECK(none.report.why_not == "from no side it can be told what belongs to it");
}

TEST_CASE("the guard: what an object's own pictures show is not cut off") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing thing(options, "background");  // touched by every thing, and hidden by it
  const CleanObject object = thing.clean();
  CHECK_FALSE(object.report.cleaned);
  CHECK(object.report.why_not == "what they would take off is seen in the scene, too");
  CHECK(object.report.left + object.report.split + object.report.made_solid + object.report.recoloured == 0);
  CHECK(same_rows(object.cloud, thing.as_labelled()));
}

TEST_CASE("clean edges: the same bits on one thread and on four") {
  const Thing thing(hard_edges(), "orange");
  CleanObject one, four;
  tbb::task_arena(1).execute([&] { one = thing.clean(); });
  tbb::task_arena(4).execute([&] { four = thing.clean(); });
  REQUIRE(one.report.cleaned);
  CHECK(same_rows(one.cloud, four.cloud));
  CHECK(one.gaussian == four.gaussian);
}

TEST_CASE("clean edges: a cancelled job cleans nothing") {
  const Thing thing(hard_edges(), "orange");
  std::stop_source stop;
  stop.request_stop();
  CHECK_FALSE(thing.clean(thing.test.truth_labels, false, {stop.get_token(), {}}).report.cleaned);
}

TEST_CASE("clean edges: one Gaussian, and none, are left as they are") {
  const GaussianCloud cloud = random_cloud(50, 2);
  for (const int count : {0, 1}) {
    std::vector<std::uint8_t> labels(cloud.size(), 0);
    std::fill_n(labels.begin(), count, 1);
    const CleanObject object = clean_object({cloud, labels, {0, -1, 0}, {}});
    CHECK_FALSE(object.report.cleaned);
    CHECK_FALSE(object.report.why_not.empty());
    CHECK(object.cloud.size() == static_cast<std::size_t>(count));
  }
}

TEST_CASE("the ring of twelve sees what the test views do not: an apple without its far half") {
  StillLifeOptions options;
  options.gaussians = 20000;
  Thing thing(options, "apple");
  thing.test.test_views.resize(1);
  thing.test.truth_masks.resize(1);
  std::vector<std::uint8_t> labels = thing.test.truth_labels;
  const CutoutScore whole = score_cutout(thing.test, labels);
  REQUIRE(whole.kept_ring);
  CHECK(whole.kept_ring->iou > 0.999);
  const Camera& from = thing.test.test_views.front();
  const float middle = from.camera_from_world(object_extent(thing.scene.cloud, labels).centre_world).z;
  for (std::size_t g = 0; g < labels.size(); ++g)
    if (from.camera_from_world(thing.scene.cloud.position[g]).z > middle) labels[g] = 0;
  const CutoutScore half = score_cutout(thing.test, labels);
  MESSAGE("in front ", half.kept.iou, ", in the ring ", half.kept_ring->iou);
  CHECK(half.kept.iou > 0.9);
  CHECK(half.kept_ring->iou < half.kept.iou - 0.1);
  EvaluationCase masks = thing.test;
  masks.truth_labels.clear();
  masks.own_labels.clear();
  CHECK_FALSE(score_cutout(masks, labels).kept_ring);
}
