// The strip of thumbnails: views keep their places from one cut to the next.
#include "app/picture/cut_pictures.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "app/document/selection.h"
#include "hands.h"
#include "segment/masks/mask_tools.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr float kTurn = 6.2831853f;

// Around the origin; twelve steps are a whole turn.
ViewCard around(float step, bool used = false) {
  const float angle = kTurn * step / 12;
  ViewCard card;
  card.camera = look_at({3 * std::sin(angle), -1, -3 * std::cos(angle)}, {0, 0, 0}, {0, -1, 0}, 0.9f, 64, 48);
  card.used = used;
  card.only_to_look = !used;
  return card;
}

std::vector<ViewCard> cards(std::initializer_list<float> steps) {
  std::vector<ViewCard> out;
  for (const float step : steps) out.push_back(around(step, out.empty()));
  return out;
}

bool same_order(const std::vector<ViewCard>& a, const std::vector<ViewCard>& b) {
  return std::ranges::equal(
      a, b, [](const ViewCard& left, const ViewCard& right) { return same_view(left.camera, right.camera); });
}

}  // namespace

TEST_CASE(
    "thumbnails: a view that was clicked stays where it was, others nearly as before, new ones come last") {
  const auto before = cards({0, 1, 11, 2, 10});
  // The view at 11 was corrected: it counts now, so that the cut lists it second; the others moved a little.
  const auto after = in_places_of(before, cards({0, 11, 1.1f, 1.9f, 10.1f, 5}));
  CHECK(same_order(after, cards({0, 1.1f, 11, 1.9f, 10.1f, 5})));
}

TEST_CASE("thumbnails: nothing is lost, whatever was shown before") {
  CHECK(same_order(in_places_of({}, cards({0, 1, 2})), cards({0, 1, 2})));
  CHECK(same_order(in_places_of(cards({6, 7, 8}), cards({0, 1, 2})), cards({0, 1, 2})));
  CHECK(same_order(in_places_of(cards({0, 1, 2, 3}), cards({0, 3})), cards({0, 3})));
  CHECK(in_places_of(cards({0, 1}), {}).empty());
}

TEST_CASE("thumbnails: a border through a surface is told from that of a whole thing on a table") {
  Hands hands = hands_on_sample();
  const Scene& scene = *hands.studio().scene()->scene;
  const Drawer drawer(scene.cloud, nullptr, nullptr);
  RasterOptions options;
  options.depth = true;
  // Of all views around what was clicked.
  const auto most = [&](const std::vector<std::uint8_t>& labels) {
    double share = 0;
    for (const ViewCard& card : hands.studio().cuts().run(hands.studio().document().active)->views) {
      const Mask mask = thresholded(render_labels(drawer, card.camera, labels), 0.5f);
      const RasterOutput drawn = rasterize(scene.cloud, limited_to_width(card.camera, 160), options);
      share = std::max(share, share_through_surface(drawn, mask));
    }
    return share;
  };
  for (const std::uint8_t thing : {kApple, kOrange, kMug}) CHECK(most(sample_truth(scene, thing)) < 0.15);
  for (const auto& [thing, axis, from] :
       {std::tuple{kMug, 0, 0.0f}, {kMug, 2, -0.34f}, {kApple, 0, 0.4f}, {kApple, 2, -0.48f}}) {
    CAPTURE(static_cast<int>(thing));
    CAPTURE(axis);
    std::vector<std::uint8_t> half = sample_truth(scene, thing);
    for (std::size_t g = 0; g < half.size(); ++g) half[g] = half[g] && scene.cloud.position[g][axis] > from;
    REQUIRE(count_flags(half) > 500);
    CHECK(most(half) > 0.2);
  }
}

TEST_CASE("thumbnails: sides in doubt are marked, and the message says so") {
  Hands hands = hands_on_sample();
  const auto doubtful = [&] {
    const CutRun* run = hands.studio().cuts().run(hands.studio().document().active);
    return std::ranges::count_if(run->views, [](const ViewCard& c) { return !c.doubt.empty(); });
  };
  CHECK(doubtful() == 0);
  CHECK(hands.said().find("in doubt") == std::string::npos);
  while (doubtful() == 0) {  // smaller parts of the apple end on the apple
    hands.app.key(key::kPageDown);
    REQUIRE(hands.app.settle());
    REQUIRE(hands.said().find("smallest") == std::string::npos);
  }
  CHECK(hands.said().find("right from here") == std::string::npos);  // nobody can know that
  CHECK(hands.said().find("sides in doubt are marked in the thumbnails") != std::string::npos);
  // It stays in the panel, once, also where the size is taken again; a click on the mark goes there.
  for (const int step : {0, key::kPageUp, key::kPageDown}) {
    if (step != 0) hands.app.key(step);
    REQUIRE(hands.app.settle());
  }
  const CutRun* run = hands.studio().cuts().run(hands.studio().document().active);
  CHECK(std::ranges::count_if(run->doubts, [](const std::string& d) {
          return d.find("in doubt are marked in the thumbnails") != d.npos;
        }) == 1);
  const auto marked = std::ranges::find_if(run->views, [](const ViewCard& c) { return !c.doubt.empty(); });
  REQUIRE(marked != run->views.end());
  const Camera there = marked->camera;
  const UiRect card = hands.app.button(fmt::format("side {}", std::distance(run->views.begin(), marked)));
  REQUIRE(card.min.x >= hands.app->interface().viewport().max.x);
  hands.app.click(0.5f * (card.min + card.max));
  REQUIRE(hands.app.settle());
  const Camera now = hands.studio().viewport().pane_camera();
  CHECK(glm::distance(now.centre_world(), there.centre_world()) < 1e-3f);
  CHECK(glm::dot(now.forward_world(), there.forward_world()) > 0.9999f);
}

TEST_CASE("thumbnails: after an edit by hand they show what there is now, and doubt nothing else") {
  Hands hands = hands_on_sample();
  const auto run = [&] { return hands.studio().cuts().run(hands.studio().document().active); };
  while (std::ranges::all_of(run()->views, [](const ViewCard& c) { return c.doubt.empty(); })) {
    hands.app.key(key::kPageDown);
    REQUIRE(hands.app.settle());
    REQUIRE(hands.said().find("smallest") == std::string::npos);
  }
  const auto pixels = [&] {
    std::vector<std::vector<Rgba8>> all;
    for (const ViewCard& c : run()->views)
      all.emplace_back(c.picture->pixels().begin(), c.picture->pixels().end());
    std::ranges::sort(all);
    return all;
  };
  const auto told = [&] {
    return std::ranges::any_of(run()->doubts,
                               [](const std::string& d) { return d.find("in doubt") != d.npos; });
  };
  const auto marks = [&] {
    return std::ranges::count_if(run()->views, [](const ViewCard& c) { return !c.doubt.empty(); });
  };
  const auto before = pixels();
  REQUIRE(told());
  // A rectangle over the apple takes more of it.
  const Camera camera = hands.studio().viewport().pane_camera();
  const glm::vec2 at = hands.in_viewport(hands.app.screen_of(kOnApple));
  hands.studio().apply(
      SelectRegion{camera, rectangle_region(at - 30.0f, at + 30.0f, camera.width_px, camera.height_px)});
  REQUIRE(hands.app.settle());
  REQUIRE(run()->result->labels != hands.studio().labels(hands.studio().document().active));
  CHECK(pixels() != before);
  CHECK(told() == (marks() > 0));
  const std::string said = hands.said();
  CHECK(said.find("added") != std::string::npos);
  hands.studio().apply(EditSelection{SelectionEdit::kNone});
  REQUIRE(hands.app.settle());
  CHECK(run()->views.empty());
  CHECK_FALSE(told());
  for (int i = 0; i < 2; ++i) {
    hands.studio().apply(Undo{});
    REQUIRE(hands.app.settle());
  }
  CHECK(pixels() == before);
  CHECK(told());
}

TEST_CASE("thumbnails: sides that no picture of the capture shows are in doubt, and no others") {
  Hands hands = hands_on_sample(false);
  const OpenedScene& scene = *hands.studio().scene();
  const std::vector<Camera>& all = scene.views().cameras;
  const glm::vec3 middle = scene.bounds.centre();
  const auto towards = [&](const Camera& camera) {
    glm::vec3 away = camera.centre_world() - middle;
    away.y = 0;
    return glm::normalize(away);
  };
  std::vector<Camera> half;  // from one side: 70 degrees about the first
  for (const Camera& camera : all)
    if (glm::dot(towards(camera), towards(all[0])) > 0.35f) half.push_back(camera);
  REQUIRE(half.size() >= 3);
  REQUIRE(half.size() < all.size());
  for (const auto& [capture, marks] : {std::pair(half, true), {all, false}, {std::vector<Camera>(), false}}) {
    CAPTURE(capture.size());
    Session session({.cloud = scene.cloud, .blocks = scene.blocks, .photographs = capture});
    CutRequest request;
    request.strokes = {{all[0], {click(kOnMug, SeedLabel::kObject)}, {}}};
    const CutSettings settings = {};
    const CutResult result = session.cut(request, settings);
    const std::vector<ViewCard> cards = picture_cards(session, {request, settings, result}, {});
    REQUIRE(cards.size() == 7);
    std::size_t marked = 0;
    for (const ViewCard& card : cards) {
      const float beside = glm::dot(towards(card.camera), towards(all[0]));
      if (beside > 0) CHECK(card.doubt.empty());
      if (marks && beside < -0.55f) CHECK_FALSE(card.doubt.empty());
      marked += !card.doubt.empty();
      if (!card.doubt.empty()) CHECK(card.doubt.find("no picture of the capture shows this side") == 0);
    }
    CHECK((marked > 0) == marks);
  }
}

TEST_CASE("thumbnails: none shows nothing of the object, where something hides it") {
  Hands hands = hands_on_sample(false);
  const OpenedScene& scene = *hands.studio().scene();
  Session session({.cloud = scene.cloud, .blocks = scene.blocks});
  CutRequest request;
  request.strokes = {{scene.views().cameras[0], {click(kOnApple, SeedLabel::kObject)}, {}}};
  const CutSettings settings;
  const CutResult whole = session.cut(request, settings);
  const Drawer drawer(*scene.cloud, nullptr, nullptr);
  std::size_t hidden = 0;
  // Patches of the apple's skin, which the apple hides from behind.
  for (const float from : {-0.42f, -0.40f, -0.38f, -0.36f, -0.34f}) {
    std::vector<std::uint8_t> patch = sample_truth(*scene.scene, kApple);
    for (std::size_t g = 0; g < patch.size(); ++g) patch[g] = patch[g] && scene.cloud->position[g].z > from;
    if (count_flags(patch) == 0) continue;
    const CutResult result = with_labels(session, whole, patch, {});
    const auto px_in = [&](const Camera& camera) {
      return count(thresholded(render_labels(drawer, limited_to_width(camera, 160), patch), 0.5f));
    };
    const std::vector<ViewCard> cards = picture_cards(session, {request, settings, result}, {});
    REQUIRE(!cards.empty());
    for (const ViewCard& card : std::span(cards).subspan(1)) CHECK(px_in(card.camera) >= 24);
    for (const GivenView& view : session.look_around(request, result, settings, 6, {}))
      hidden += px_in(view.camera) < 24;
    MESSAGE(from, ": ", count_flags(patch), " Gaussians, ", cards.size(), " thumbnails, ", hidden);
  }
  CHECK(hidden > 0);
}

TEST_CASE("thumbnails: half a thing stays in doubt when a whole one joins, until looked at or made whole") {
  Hands hands = hands_on_sample(false);
  const OpenedScene& scene = *hands.studio().scene();
  Session session({.cloud = scene.cloud, .blocks = scene.blocks});
  CutRequest request;
  request.strokes = {{scene.views().cameras[0], {click(kOnApple, SeedLabel::kObject)}, {}}};
  CutResult result = session.cut(request, {});
  const auto cards = [&](const std::vector<std::uint8_t>& labels) {
    return picture_cards(session, {request, {}, with_labels(session, result, labels, {})}, {});
  };
  const auto through = [](const std::vector<ViewCard>& all) {
    return std::ranges::count(all, "here the border runs through a surface", &ViewCard::doubt);
  };
  const std::vector<std::uint8_t> apple = sample_truth(*scene.scene, kApple),
                                  mug = sample_truth(*scene.scene, kMug);
  std::vector<std::uint8_t> half = apple, joined = apple;
  for (std::size_t g = 0; g < half.size(); ++g) {
    half[g] = half[g] && scene.cloud->position[g].z > -0.48f;
    joined[g] = half[g] || mug[g];
  }
  std::vector<ViewCard> before = cards(half);
  REQUIRE(through(before) > 0);
  std::vector<ViewCard> now = cards(joined);
  const auto anew = through(now);
  REQUIRE(anew < through(before));  // by itself it would be forgotten
  keep_doubts(before, joined, &now);
  CHECK(through(now) > anew);
  std::vector<ViewCard> whole = cards(apple);
  keep_doubts(before, apple, &whole);
  CHECK(through(whole) == 0);
  // It is looked at from there, not from beside, nor where something else fills the picture.
  for (ViewCard& card : before) {
    if (card.open.empty()) continue;
    CHECK(looks_at(card.camera, card, *scene.cloud));
    Camera other = card.camera;
    other.cx_px += 2 * static_cast<float>(other.width_px);
    CHECK_FALSE(looks_at(other, card, *scene.cloud));
    for (const ViewCard& beside : before)
      if (&beside != &card) CHECK_FALSE(looks_at(beside.camera, card, *scene.cloud));
    card.looked_at = true;
  }
  now = cards(joined);
  keep_doubts(before, joined, &now);
  CHECK(through(now) == anew);
}

TEST_CASE(
    "thumbnails: what a stroke took stays in doubt beside a border's doubt, and counts once however often "
    "kept") {
  const auto card_with = [](std::vector<std::shared_ptr<const OpenDoubt>> open) {
    ViewCard card;
    card.camera = look_at({0, 0, -5}, {0, 0, 0}, {0, -1, 0}, 1, 40, 30);
    card.open = std::move(open);
    return card;
  };
  const auto taken = std::make_shared<const OpenDoubt>(OpenDoubt{.out = {0, 1, 2}}),
             border = std::make_shared<const OpenDoubt>(OpenDoubt{.out = {4}, .in = {5}, .is_border = true});
  const std::vector<std::uint8_t> labels = {0, 0, 0, 1, 0, 1}, mended = {0, 0, 0, 1, 1, 1},
                                  back = {1, 1, 0, 1, 1, 1};
  std::vector<ViewCard> now = {card_with({border})};
  for (int i = 0; i < 3; ++i) keep_doubts({card_with({taken})}, labels, &now);
  REQUIRE(now.front().open.size() == 2);
  CHECK(now.front().open.back()->out == taken->out);
  std::vector<ViewCard> after = {card_with({})}, undone = {card_with({})};
  keep_doubts(now, mended, &after);  // the border is right now
  REQUIRE(after.front().open.size() == 1);
  CHECK(after.front().open.front()->out == taken->out);
  CHECK_FALSE(after.front().doubt.empty());
  keep_doubts(now, back, &undone);  // and most of what was taken is back
  CHECK(undone.front().open.empty());
  CHECK(undone.front().doubt.empty());
}
