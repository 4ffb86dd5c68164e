// The same answer for the same scene: in other units, and how well for clicks of an unsteady hand.
#include <doctest/doctest.h>

#include <algorithm>

#include "app/measure/click_draws.h"
#include "app/measure/robot_user.h"
#include "core/error.h"
#include "cut_in_view.h"
#include "still_life_table.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("the natural near plane is a hundredth of the scene's diagonal, and never nothing") {
  const std::vector<glm::vec3> corners = {{0, 0, 0}, {3, 4, 12}};
  CHECK(natural_near_plane(corners) == doctest::Approx(0.13f));
  CHECK(natural_near_plane(std::vector<glm::vec3>(5, glm::vec3(7))) > 0);
  CHECK(natural_near_plane({}) > 0);
}

TEST_CASE("the near plane of a scene stays where it is when a hundred copies of it stand far apart") {
  const GaussianCloud& one = table().cloud;
  CHECK(near_plane_of(one) == natural_near_plane(one.position));
  constexpr std::size_t kCopies = 100;
  GaussianCloud street;
  street.resize(kCopies * one.size(), 0);
  for (std::size_t g = 0; g < street.size(); ++g) {
    street.position[g] = one.position[g / kCopies] + glm::vec3(50.0f * static_cast<float>(g % kCopies), 0, 0);
    street.scale[g] = one.scale[g / kCopies];
  }
  CHECK(natural_near_plane(street.position) > 45);
  CHECK(near_plane_of(street) < 10 * near_plane_of(one));
  for (glm::vec3& scale : street.scale) scale = glm::vec3(0);
  CHECK(near_plane_of(street) == natural_near_plane(street.position));
}

TEST_CASE("parts: a scene in other units is cut the same") {
  const Table& t = table();
  const Target mug = target(t, "mug");
  const auto labels_at = [&](float scale) {
    GaussianCloud cloud = t.cloud;
    for (glm::vec3& p : cloud.position) p *= scale;
    for (glm::vec3& s : cloud.scale) s *= scale;
    cloud.near_plane = natural_near_plane(cloud.position);
    Camera camera = mug.camera;
    camera.camera_from_world_translation *= scale;
    const glm::vec2 middle =
        robot_click(mug.truth, Mask(mug.truth.width(), mug.truth.height()))->points_px[0];
    return cut_in_view(cloud, camera, {0, 1, 0}, {click(middle, SeedLabel::kObject)}, CutSettings()).labels;
  };
  const std::vector<std::uint8_t> one = labels_at(1);
  CHECK(std::ranges::count(one, 1) > 1000);
  for (const float scale : {1.0f / 64, 64.0f})
    CHECK(labels_at(scale) == one);  // powers of two: the same bits
  std::size_t differ = 0;
  const std::vector<std::uint8_t> hundredth = labels_at(0.01f);
  for (std::size_t g = 0; g < one.size(); ++g) differ += one[g] != hundredth[g];
  CHECK(differ < one.size() / 1000);
}

TEST_CASE("parts: draws of unsteady clicks, their median, their least and the clicks to a goal") {
  const Table& t = table();
  EvaluationCase scene;
  scene.cloud = &t.cloud;
  const auto index = std::ranges::find(t.scene.label_name, "mug") - t.scene.label_name.begin();
  for (const auto label : t.label) scene.truth_labels.push_back(label == index);
  scene.reference = target(t, "mug").camera;
  render_truth(&scene);
  const ClickDraws draws = draw_clicks(scene, preset("default"), 3, 4);
  REQUIRE(draws.iou_after.size() == 4);
  Session session = session_of(scene);
  CHECK(draws.iou_after[0] == robot_session(scene, &session, preset("default"), 3).iou_after);
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> at;
    for (const auto& ious : draws.iou_after) at.push_back(ious[k]);
    std::ranges::sort(at);
    CHECK(draws.least[k] == at.front());
    CHECK(draws.median[k] == doctest::Approx((at[1] + at[2]) / 2));
  }
  CHECK(draws.least_from_second == std::min(draws.least[1], draws.least[2]));
  CHECK(draws.mean_noc90 >= draws.mean_noc85);
  CHECK(draws.most_noc90 >= draws.mean_noc90);
  // The same scene known by masks of its views: each of them is clicked.
  EvaluationCase photographs = scene;
  photographs.test_views = {scene.reference, scene.reference};
  photographs.truth_masks = {*scene.reference_truth, *scene.reference_truth};
  photographs.truth_labels.clear();
  photographs.reference_truth.reset();
  CHECK(draw_clicks(photographs, preset("default"), 3, 2).iou_after.size() == 4);
  photographs.test_views.clear();
  CHECK(draw_clicks(photographs, preset("default"), 3, 2).iou_after.empty());
  CHECK_THROWS_AS(robot_session(photographs, &session, preset("default"), 1), Error);
}
