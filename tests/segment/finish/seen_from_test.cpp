// From which sides an object was seen: things on a table, with the cameras around it and without.
#include "segment/finish/seen_from.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "segment/finish/own_views.h"
#include "segment/finish/shown_part.h"
#include "thing_of_still_life.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("seen from: nobody saw a thing on a table from below, with a capture's cameras or without") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing apple(options, "apple");
  const glm::vec3 from = apple.scene.cameras[0].centre_world();
  for (const bool capture : {true, false}) {
    CAPTURE(capture);
    const SeenFrom seen =
        seen_from(apple.scene.cloud, apple.test.truth_labels, {0, -1, 0}, from,
                  capture ? std::span<const Camera>(apple.scene.cameras) : std::span<const Camera>(), {});
    CHECK(seen.never() == std::vector<std::string>{"below"});
    float unseen = 0;
    for (const float share : seen.side_share) unseen += share >= kEnoughSeenShare ? 0 : (1 - share) / 6;
    CHECK(seen.unseen_share() == doctest::Approx(unseen).epsilon(1e-5));
    CHECK(seen.unseen_share() >= (1 - kLeastSeenShare) / 6);
    CHECK(seen.unseen_share() < 0.4f);
    const auto given = capture ? std::span<const Camera>(apple.scene.cameras) : std::span<const Camera>();
    CHECK(seen_sides(apple.scene.cloud, apple.test.truth_labels, {0, -1, 0}, from, given, {}).side_share ==
          seen.side_share);
    CHECK(seen_by_views(apple.scene.cloud, apple.test.truth_labels, {0, -1, 0}, given, {}).by_views ==
          seen.by_views);
    CHECK(seen.side_share[0] > 0.95f);  // the front: nothing stands before it
    CHECK(seen.by_views.size() == static_cast<std::size_t>(std::ranges::count(apple.test.truth_labels, 1)));
    const auto by_some = std::ranges::count_if(seen.by_views, [](std::uint32_t by) { return by != 0; });
    CHECK(static_cast<double>(by_some) > 0.8 * static_cast<double>(seen.by_views.size()));
    for (const std::uint32_t by : seen.by_views)
      CHECK(std::bit_width(by) <= static_cast<int>(seen.views.size()));
  }
}

TEST_CASE("seen from: from straight above nothing is in front, and no level side has a name") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing apple(options, "apple");
  const std::vector<std::uint8_t>& labels = apple.test.truth_labels;
  const glm::vec3 up(0, -1, 0), middle = object_extent(apple.scene.cloud, labels).centre_world;
  std::vector<Camera> above = {apple.scene.cameras[0]};
  above[0] = look_at(middle + up, middle, {0, 0, 1}, 0.9f, 160, 160);
  const auto never = [&](const glm::vec3& from) {
    return seen_sides(apple.scene.cloud, labels, up, from, above, {}).never();
  };
  CHECK(never(middle) == std::vector<std::string>{"below"});
  CHECK(never(middle + up) == std::vector<std::string>{"below"});
  CHECK(never(middle + glm::vec3(0.3f, 0, 0)).size() == 5);
}

TEST_CASE(
    "seen from: a side is seen by cameras that look at the object, and all are asked where none sees "
    "enough") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing apple(options, "apple");
  const std::vector<std::uint8_t>& labels = apple.test.truth_labels;
  const Drawer scene(apple.scene.cloud);
  const glm::vec3 from = apple.scene.cameras[0].centre_world(), up(0, -1, 0);
  std::vector<Camera> away = apple.scene.cameras;  // in the same places, turned about
  for (Camera& camera : away)
    camera = look_at(camera.centre_world(), camera.centre_world() - camera.forward_world(), up, 0.9f, 64, 48);
  for (const std::vector<Camera>& capture : {apple.scene.cameras, std::vector<Camera>(), away}) {
    CAPTURE(capture.size());
    const SeenFrom all = seen_from(scene, labels, up, from, capture, {});
    const SeenSides sides(scene, labels, up, from - object_extent(apple.scene.cloud, labels).centre_world,
                          capture);
    for (std::size_t s = 0; s < all.sides.size(); ++s) {
      CAPTURE(kSideNames.at(s));
      const float whole = sides.share(all.sides.at(s), 1, {});
      CHECK(sides.share(all.sides.at(s), kEnoughSeenShare, {}) == all.side_share.at(s));
      CHECK(all.side_share.at(s) >= std::min(whole, kEnoughSeenShare));
      const float some = sides.share(all.sides.at(s), kLeastSeenShare, {});
      CHECK(some <= all.side_share.at(s));
      CHECK((some >= kLeastSeenShare) == (all.side_share.at(s) >= kLeastSeenShare));
    }
  }
  CHECK(seen_from(scene, labels, up, from, away, {}).never().size() == kSideNames.size());
}

TEST_CASE("seen from: of a capture from one side, the others were not seen, and the picture says so in red") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing apple(options, "apple");
  std::vector<Camera> front;  // within 45 degrees of the first, as the 24 stand 15 degrees apart
  for (const int c : {21, 22, 23, 0, 1, 2, 3})
    front.push_back(apple.scene.cameras[static_cast<std::size_t>(c)]);
  front.push_back(front[3]);
  const SeenFrom seen =
      seen_from(apple.scene.cloud, apple.test.truth_labels, {0, -1, 0}, front[3].centre_world(), front, {});
  const std::vector<std::string> never = seen.never();
  for (const char* side : {"back", "below"}) CHECK(std::ranges::count(never, side) == 1);
  CHECK(std::ranges::count(never, "front") == 0);
  const Image<Rgb8> picture = seen_picture(seen, apple.scene.cloud, apple.test.truth_labels, {});
  const auto middle_of = [&](int side) {
    return picture.at(picture.width() / 6 * (1 + 2 * (side % 3)),
                      picture.height() / 4 * (1 + 2 * (side / 3)));
  };
  const Rgb8 in_front = middle_of(0), behind = middle_of(2);
  CHECK(in_front[2] > in_front[0]);  // blue
  CHECK(behind[0] > 3 * behind[2]);  // red
}

TEST_CASE("seen from: Gaussians in one place are an object as large as they are") {
  GaussianCloud cloud;
  cloud.resize(3, 0);
  for (std::size_t g = 0; g < 3; ++g) {
    cloud.position[g] = {1, 2, 3};
    cloud.scale[g] = glm::vec3(0.1f * static_cast<float>(g + 1), 0.05f, 0.05f);
    cloud.rotation[g] = {1, 0, 0, 0};
    cloud.opacity[g] = 0.9f;
  }
  const std::vector<std::uint8_t> two = {1, 1, 0};
  const ObjectExtent extent = object_extent(cloud, two);
  CHECK(extent.centre_world == cloud.position[0]);
  CHECK(extent.radius == doctest::Approx(3 * 0.2));
  const SeenFrom seen = seen_from(cloud, two, {0, -1, 0}, {1, 2, 0}, {}, {});
  CHECK(seen.by_views.size() == 2);
  for (const float share : seen.side_share) CHECK(std::isfinite(share));
}

TEST_CASE("seen from: what is small beside its scene's near plane is seen as with a nearer one, and whole") {
  StillLifeOptions options;
  options.gaussians = 20000;
  const Thing apple(options, "apple");
  const std::vector<std::uint8_t>& labels = apple.test.truth_labels;
  const ObjectExtent extent = object_extent(apple.scene.cloud, labels);
  const glm::vec3 from = apple.scene.cameras[0].centre_world(), up(0, -1, 0);
  GaussianCloud near = apple.scene.cloud, far = near;
  near.near_plane = 1.2f * extent.radius;
  far.near_plane = 5 * extent.radius;  // as a sky makes it: farther than the views of a side stand
  const SeenFrom seen = seen_from(far, labels, up, from, {}, {});
  CHECK(seen.side_share[0] > 0.95f);
  CHECK(seen.side_share == seen_from(near, labels, up, from, {}, {}).side_share);
  const GaussianCloud alone = permuted(far, labelled_rows(labels));
  for (const Camera& camera : own_cameras(far, labels, up, {}, {}))
    CHECK(own_view(far, alone, labels, camera, {}).shown_px > 1000);
  for (const Camera& camera : cameras_around(apple.scene.cameras[0], up, extent, {}, {})) {
    CHECK(near_plane_for(far, camera) < 2 * extent.radius);
    GaussianCloud with_room = far;
    with_room.near_plane = 0.5f * extent.radius;
    CHECK(near_plane_for(with_room, camera) == with_room.near_plane);  // as it was
  }
}
