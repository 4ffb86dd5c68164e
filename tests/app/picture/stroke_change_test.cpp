// Thumbnails show what the last stroke changed, and doubt a side that lost or got something out of its sight.
#include "app/picture/stroke_change.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "app/picture/cut_pictures.h"
#include "segment/masks/mask_tools.h"

using namespace splatcut;

namespace {

using Labels = std::vector<std::uint8_t>;

// Grey, empty boxes of 1 x 1 x 1 about places on the x axis, of round Gaussians on their six sides.
GaussianCloud boxes(std::initializer_list<float> places_x) {
  constexpr int kSteps = 24;
  GaussianCloud cloud;
  cloud.resize(places_x.size() * 6 * kSteps * kSteps, 0);
  std::size_t g = 0;
  for (const float x : places_x)
    for (int side = 0; side < 6; ++side)
      for (int u = 0; u < kSteps; ++u)
        for (int v = 0; v < kSteps; ++v, ++g) {
          glm::vec3& at = cloud.position[g];
          at[side / 2] = side % 2 ? 0.5f : -0.5f;
          at[(side / 2 + 1) % 3] = (static_cast<float>(u) + 0.5f) / kSteps - 0.5f;
          at[(side / 2 + 2) % 3] = (static_cast<float>(v) + 0.5f) / kSteps - 0.5f;
          at.x += x;
          cloud.scale[g] = glm::vec3(0.03f);
          cloud.opacity[g] = 0.95f;
          cloud.file_row[g] = static_cast<std::uint32_t>(g);
        }
  return cloud;
}

// Clicked from the front, where z is least.
struct Clicked {
  std::shared_ptr<const GaussianCloud> cloud;
  Session session{{.cloud = cloud}};
  CutRequest request{
      .strokes = {{look_at({0, -1, -4}, {0, 0, 0}, {0, -1, 0}, 0.9f, 320, 240),
                   {click({160, 120}, SeedLabel::kObject), click({10, 10}, SeedLabel::kRest)}}}};

  Labels where(const auto& holds) const {
    Labels labels(cloud->size());
    std::ranges::transform(cloud->position, labels.begin(),
                           [&](const glm::vec3& p) { return static_cast<std::uint8_t>(holds(p)); });
    return labels;
  }
  std::vector<ViewCard> cards(const Labels& before, const Labels& after) {
    const Camera& camera = request.strokes.front().camera;
    CutResult result;
    result.labels = after;
    result.views.push_back(
        {.camera = camera, .mask = thresholded(render_labels(*cloud, camera, after), 0.5f), .used = true});
    return picture_cards(session, {request, CutSettings(), result, {40, 90, 255}, make_flags(before)}, {});
  }
};

enum Side { kFront, kFlank, kBehind };
enum Channel : std::size_t { kRed, kGreen, kBlue };

Side side_of(const ViewCard& card) {
  const glm::vec3 level = glm::normalize(card.camera.centre_world() * glm::vec3(1, 0, 1));
  return level.z < -0.9f ? kFront : level.z > 0.45f ? kBehind : kFlank;
}

// Pixels of the picture in which a channel stands out.
std::ptrdiff_t pixels_of(const ViewCard& card, Channel channel) {
  return std::ranges::count_if(card.picture->pixels(), [&](const Rgba8& p) {
    const int others = std::max(p.at((channel + 1) % 3), p.at((channel + 2) % 3));
    return p.at(channel) > others + 60;
  });
}

bool anything(const glm::vec3& /*position*/) {
  return true;
}

constexpr const char* kTaken = "what is red here was taken away, unseen from where you clicked or drew";
constexpr const char* kCameUnseen = "what is green here was added, unseen from where you clicked or drew";

std::ptrdiff_t of_stroke(const std::vector<ViewCard>& cards) {
  return std::ranges::count_if(cards, &ViewCard::doubt_of_stroke);
}

}  // namespace

TEST_CASE("thumbnails: what a click took away out of its sight is red from behind, and in doubt there") {
  Clicked box{std::make_shared<const GaussianCloud>(boxes({0}))};
  const auto kept = [](const glm::vec3& p) { return p.z < 0.45f; };
  const std::vector<ViewCard> cards = box.cards(box.where(anything), box.where(kept));
  REQUIRE(cards.size() == 7);
  int behind = 0;
  for (const ViewCard& card : cards) {
    CAPTURE(card.camera.centre_world().z);
    const Side side = side_of(card);
    behind += side == kBehind;
    if (side == kFront) CHECK(pixels_of(card, kRed) == 0);
    if (side == kFront) CHECK(card.doubt.empty());
    if (side != kBehind) continue;
    CHECK(pixels_of(card, kRed) > 500);
    CHECK(card.doubt == kTaken);
    CHECK(card.doubt_of_stroke);
  }
  CHECK(behind >= 2);
}

TEST_CASE("thumbnails: what a click changed in sight is marked, and in no doubt") {
  Clicked box{std::make_shared<const GaussianCloud>(boxes({0}))};
  const auto kept = [](const glm::vec3& p) { return p.z > -0.45f; };
  const std::vector<ViewCard> taken = box.cards(box.where(anything), box.where(kept));
  CHECK(pixels_of(taken.front(), kRed) > 500);
  CHECK(of_stroke(taken) == 0);
  const std::vector<ViewCard> added = box.cards(box.where(kept), box.where(anything));
  CHECK(pixels_of(added.front(), kGreen) > 500);
  CHECK(pixels_of(added.front(), kRed) == 0);
  CHECK(of_stroke(added) == 0);
}

TEST_CASE("thumbnails: what a click added out of its sight is green from behind, and in doubt there") {
  Clicked box{std::make_shared<const GaussianCloud>(boxes({0}))};
  const auto was = [](const glm::vec3& p) { return p.z < 0.45f; };
  for (const ViewCard& card : box.cards(box.where(was), box.where(anything))) {
    CAPTURE(card.camera.centre_world().z);
    if (side_of(card) == kFront) CHECK(card.doubt.empty());
    if (side_of(card) != kBehind) continue;
    CHECK(pixels_of(card, kGreen) > 500);
    CHECK(card.doubt == kCameUnseen);
  }
}

TEST_CASE("thumbnails: a side from which all of the object went is still shown, and in doubt") {
  Clicked box{std::make_shared<const GaussianCloud>(boxes({0}))};
  const auto front = [](const glm::vec3& p) { return p.z < -0.49f; };
  const auto both = [](const glm::vec3& p) { return std::abs(p.z) > 0.49f; };
  int gone = 0;
  for (const ViewCard& card : box.cards(box.where(both), box.where(front)))
    if (pixels_of(card, kBlue) == 0) {
      ++gone;
      CHECK(pixels_of(card, kRed) > 500);
      CHECK(card.doubt == kTaken);
    }
  CHECK(gone >= 2);
}

TEST_CASE("thumbnails: a little out of sight is no doubt, nor is what was displayed without what hides it") {
  Clicked two{std::make_shared<const GaussianCloud>(boxes({0, 1.5f}))};
  const auto left_one = [](const glm::vec3& p) { return p.x < 0.6f; };
  const auto but_a_corner = [&](const glm::vec3& p) {
    return left_one(p) && !(p.z > 0.45f && p.x > 0.38f && p.y > 0.38f);
  };
  CHECK(of_stroke(two.cards(two.where(left_one), two.where(but_a_corner))) == 0);
  // The back is in sight where it is displayed without what stands before it.
  Clicked alone{std::make_shared<const GaussianCloud>(boxes({0}))};
  const auto back = [](const glm::vec3& p) { return p.z > 0.49f; };
  const auto kept = [](const glm::vec3& p) { return p.z < 0.49f; };
  CHECK(of_stroke(alone.cards(alone.where(anything), alone.where(kept))) > 0);
  alone.request.strokes.front().seen = make_flags(alone.where(back));
  CHECK(of_stroke(alone.cards(alone.where(anything), alone.where(kept))) == 0);
}

TEST_CASE("thumbnails: a first click, and one that changes nothing, has no change to show") {
  Clicked box{std::make_shared<const GaussianCloud>(boxes({0}))};
  const auto pixels = [](const std::vector<ViewCard>& cards) {
    std::vector<Rgba8> all;
    for (const ViewCard& card : cards)
      all.insert(all.end(), card.picture->pixels().begin(), card.picture->pixels().end());
    return all;
  };
  const Labels now = box.where([](const glm::vec3& p) { return p.z < 0.45f; });
  const Labels nothing(now.size(), 0);
  const auto plain = pixels(box.cards(now, now));
  CHECK(pixels(box.cards(nothing, now)) == plain);
  CHECK(of_stroke(box.cards(nothing, now)) == 0);
  const auto changed = pixels(box.cards(box.where(anything), now));
  CHECK(changed != plain);
  CHECK(changed == pixels(box.cards(box.where(anything), now)));
}
