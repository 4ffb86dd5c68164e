// The rest of a scene without an object: planted ghosts, what was cut off, and pictures around the object.
#include "segment/finish/forget.h"

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "app/measure/evaluate_alone.h"
#include "thing_of_still_life.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

std::vector<std::uint8_t> others(const std::vector<std::uint8_t>& labels) {
  std::vector<std::uint8_t> rest;
  for (const std::uint8_t label : labels) rest.push_back(label ? 0 : 1);
  return rest;
}

// Every twentieth of the thing's Gaussians is not labelled, as where a cut missed some.
std::vector<std::uint8_t> with_some_missed(const Thing& thing, std::set<std::uint32_t>* missed) {
  std::vector<std::uint8_t> labels = thing.test.truth_labels;
  std::mt19937 random(7);
  for (std::uint32_t g = 0; g < labels.size(); ++g)
    if (labels[g] && random() % 20 == 0) {
      labels[g] = 0;
      missed->insert(g);
    }
  return labels;
}

}  // namespace

TEST_CASE(
    "forget: of what a cut missed of an object, what nobody sees around it leaves, and nothing of others") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing thing(options, "orange");
  std::set<std::uint32_t> missed;
  const std::vector<std::uint8_t> labels = with_some_missed(thing, &missed);
  const CleanObject object = thing.clean(labels, true);
  REQUIRE(object.report.cleaned);
  const std::vector<std::uint32_t>& ghosts = object.rest.ghosts;
  CHECK(std::ranges::is_sorted(ghosts));
  const auto planted = std::ranges::count_if(ghosts, [&](std::uint32_t g) { return missed.contains(g); });
  CHECK(static_cast<double>(planted) > 0.33 * static_cast<double>(missed.size()));
  CHECK(static_cast<double>(planted) > 0.9 * static_cast<double>(ghosts.size()));
  CHECK(std::ranges::none_of(ghosts, [&](std::uint32_t g) { return labels[g] != 0; }));
}

TEST_CASE("forget: of what was cut off, the rest gets back what lies among its own") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing thing(options, "orange");
  const GaussianCloud& cloud = thing.scene.cloud;
  const std::vector<std::uint8_t>& labels = thing.test.truth_labels;
  const GaussianCloud own = thing.as_labelled();
  std::vector<OwnView> views;
  for (const Camera& camera : own_cameras(cloud, labels, {0, -1, 0}, thing.scene.cameras, {}))
    views.push_back(own_view(cloud, own, labels, camera, {}));
  glm::vec3 middle(0), lowest = own.position[0];
  for (const glm::vec3& p : own.position) {
    middle += p / static_cast<float>(own.size());
    if (p.y > lowest.y) lowest = p;  // y points down
  }
  // On the table, a radius beside the orange, and in its middle.
  const float radius = lowest.y - middle.y;
  const glm::vec3 beside(middle.x + 2 * radius, lowest.y, middle.z);
  std::vector<std::uint32_t> gaussian;
  for (std::uint32_t g = 0; g < labels.size(); ++g)
    if (labels[g]) gaussian.push_back(g);
  const std::vector<CutOff> cut_off = {{3, {middle, glm::vec3(0.01f), {1, 0, 0, 0}, 0.5f}},
                                       {5, {beside, glm::vec3(0.02f), {1, 0, 0, 0}, 0.25f}}};
  const RestChanges changes = forget(cloud, labels, gaussian, views, cut_off, {}, {});
  REQUIRE(changes.given_back.size() == 1);
  CHECK(changes.given_back.position[0] == beside);
  CHECK(changes.given_back.scale[0] == glm::vec3(0.02f));
  CHECK(changes.given_back.opacity[0] == 0.25f);
  CHECK(changes.given_back.file_row[0] == cloud.file_row[gaussian[5]]);
  CHECK(changes.given_back.f_dc[0] == cloud.f_dc[gaussian[5]]);
}

TEST_CASE("forget: what surrounds an object looks no less like the scene without its ghosts") {
  StillLifeOptions options;
  options.gaussians = 20000;
  options.straddling = true;
  const Thing thing(options, "orange");
  std::set<std::uint32_t> missed;
  const std::vector<std::uint8_t> labels = with_some_missed(thing, &missed), rest = others(labels);
  const CleanObject object = thing.clean(labels, true);
  REQUIRE(object.rest.ghosts.size() > 0);
  const RestScore kept = score_rest(thing.test, rest_of(thing.scene.cloud, rest, {}));
  const RestScore clean = score_rest(thing.test, rest_of(thing.scene.cloud, rest, object.rest));
  CHECK(clean.ghost_gradient < kept.ghost_gradient);
  constexpr double kRounding = 58.9;  // of 8 bits, dB
  CHECK(clean.ring_psnr_db > std::min(kept.ring_psnr_db, kRounding));
}

TEST_CASE("forget: the rest is what is shown, without ghosts, then what was given back") {
  GaussianCloud cloud;
  cloud.resize(5, 0);
  for (std::uint32_t g = 0; g < 5; ++g) cloud.file_row[g] = 10 + g;
  RestChanges changes;
  changes.ghosts = {1, 4};
  changes.given_back.resize(1, 0);
  changes.given_back.file_row[0] = 12;
  const GaussianCloud rest = rest_of(cloud, std::vector<std::uint8_t>{1, 1, 0, 1, 0}, changes);
  CHECK(rest.file_row == std::vector<std::uint32_t>{10, 13, 12});
}

TEST_CASE("forget: nothing is asked for: nothing changes") {
  StillLifeOptions options;
  options.gaussians = 20000;
  options.straddling = true;
  const CleanObject unasked = Thing(options, "mug").clean();
  CHECK(unasked.report.cleaned);
  CHECK(unasked.rest.ghosts.size() + unasked.rest.given_back.size() == 0);
}

TEST_CASE("forget: the same bits on one thread and on four, and a cancelled job ends") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing thing(options, "orange");
  std::set<std::uint32_t> missed;
  const std::vector<std::uint8_t> labels = with_some_missed(thing, &missed);
  CleanObject one, four;
  tbb::task_arena(1).execute([&] { one = thing.clean(labels, true); });
  tbb::task_arena(4).execute([&] { four = thing.clean(labels, true); });
  REQUIRE(one.rest.ghosts.size() > 0);
  CHECK(one.rest.ghosts == four.rest.ghosts);
  CHECK(one.rest.given_back.position == four.rest.given_back.position);
  std::stop_source stop;
  stop.request_stop();
  CHECK_FALSE(thing.clean(labels, true, {stop.get_token(), {}}).report.cleaned);
}

TEST_CASE(
    "forget: in a scene of two million Gaussians more, none of which shows, the same leave and come back") {
  StillLifeOptions options;
  options.gaussians = 20000;
  options.straddling = true;
  const Thing thing(options, "orange");
  const CleanObject small = thing.clean(thing.test.truth_labels, true);
  REQUIRE(small.report.cleaned);
  REQUIRE(small.rest.ghosts.size() + small.rest.given_back.size() > 0);
  std::vector<std::uint32_t> rows(thing.scene.cloud.size() + 2'000'000, 0);
  std::iota(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(thing.scene.cloud.size()), 0u);
  GaussianCloud cloud = permuted(thing.scene.cloud, rows);
  std::fill(cloud.opacity.begin() + static_cast<std::ptrdiff_t>(thing.scene.cloud.size()),
            cloud.opacity.end(), 0.0f);
  std::vector<std::uint8_t> labels = thing.test.truth_labels;
  labels.resize(cloud.size(), 0);
  const CleanObject large = clean_object({cloud, labels, {0, -1, 0}, thing.scene.cameras, true});
  CHECK(large.rest.ghosts == small.rest.ghosts);
  CHECK(large.rest.given_back.position == small.rest.given_back.position);
}
