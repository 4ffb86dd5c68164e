// What lies over the picture leaves the rest of it to the tools; an outline that takes long is said to come.
#include <doctest/doctest.h>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("over the picture: a rectangle begins beside the options that lie over it") {
  HeadlessApp app(980, 640);
  app.interface_state().hint_wanted = false;
  app.open(kSmallSample);
  REQUIRE(app.settle());
  app.key('7');
  app.key('V');
  app.frames(3);
  REQUIRE(app.interface_state().row_below());
  const UiRect row = app.window("options"), view = app->interface().viewport();
  REQUIRE(row.size().x > 0);
  const glm::vec2 beside(std::min(row.max.x, view.max.x) - 6, row.max.y - 6);
  REQUIRE(view.contains(beside));
  CHECK(app->interface().picture_at(beside, app.studio()));
  CHECK_FALSE(app->interface().picture_at(row.min + glm::vec2(14, 14), app.studio()));
  app.drag({beside, view.min + glm::vec2(300, 250), view.min + glm::vec2(60, 400)});
  REQUIRE(app.settle());
  CHECK(app.studio().gaussians_of(app.studio().document().active) > 0);
}

TEST_CASE("over the picture: a sign at the pointer says that its outline is looked for, until it is there") {
  ApplicationOptions options;  // nothing is prepared, nor kept from before
  options.studio.works_ahead = false;
  HeadlessApp app(1000, 700, 1, options);
  app.interface_state().hint_wanted = false;
  app.open(kSample);
  REQUIRE(app.settle());
  const glm::vec2 on_apple = app.screen_of(kOnApple);
  app.move(on_apple);
  app.frames(2);
  CHECK(app.button("looking").size().x == 0);  // not yet: most outlines come at once
  REQUIRE(app.frames_until([&] { return app.button("looking").size().x > 0; }));
  CHECK(glm::distance(app.button("looking").min, on_apple) < 40);
  REQUIRE(app.settle());
  app.frames(2);
  CHECK(app.button("looking").size().x == 0);
  CHECK(app.studio().viewport().style(0).highlight);
}
