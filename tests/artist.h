// An artist who clicks in the window, on the sample and on real captures.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/work_cut.h"
#include "app/work/work_file.h"
#include "headless_app.h"
#include "scene/camera/camera_names.h"
#include "segment/masks/mask_tools.h"

namespace splatcut::testing {

using Labels = std::vector<std::uint8_t>;

inline constexpr int kArtistWidth = 900, kArtistHeight = 520;
// A folder of real captures to try the same on; the sample alone where the variable is not set.
inline std::filesystem::path capture_folder() {
  const char* folder = std::getenv("SPLATCUT_CAPTURES");
  return folder ? folder : "";
}

// One scene, with a click on a thing in it and the view that it is made in.
struct ClickedPlace {
  std::string name;
  std::filesystem::path scene;
  Camera camera;
  glm::vec2 pixel;
};

inline ClickedPlace on_sample(const std::string& name, const glm::vec2& pixel) {
  return {name, kSample, load_cameras(kSampleFolder / "cameras.json").front(), pixel};
}

// Those of them that are in capture_folder().
inline std::vector<ClickedPlace> captures(const std::vector<std::string>& names) {
  std::vector<ClickedPlace> places;
  const std::filesystem::path folder = capture_folder();
  if (folder.empty()) return places;
  const auto add = [&](const char* name, const char* scene, const char* cameras, const char* camera, float x,
                       float y) {
    if (!std::filesystem::exists(folder / scene) || std::ranges::find(names, name) == names.end()) return;
    const std::vector<Camera> all = load_cameras(folder / cameras);
    places.push_back({name, folder / scene, find_camera(all, camera, cameras), {x, y}});
  };
  add("fox", "fox/point_cloud.ply", "fox/cameras.json", "0009", 165, 150);
  add("cup", "cup/point_cloud.ply", "cup/cameras.json", "57", 255, 140);
  add("sign", "real/flowers.compressed.ply", "real/sign/cameras.json", "v0", 400, 112);
  return places;
}

inline std::vector<ClickedPlace> with_captures(std::vector<ClickedPlace> places,
                                               const std::vector<std::string>& names = {"fox", "cup",
                                                                                        "sign"}) {
  for (ClickedPlace& place : captures(names)) places.push_back(std::move(place));
  return places;
}

// The program, standing where the place is clicked.
class Artist {
 public:
  explicit Artist(const ClickedPlace& place, ApplicationOptions options = with_kept_scenes())
      : app(kArtistWidth, kArtistHeight, 1, std::move(options)), place_(place) {
    app.interface_state().hint_wanted = false;
    app.open(place.scene);
    REQUIRE(app.settle());
    go_to(place.camera);
    app.wait_for_message_to_go();
  }

  Studio& studio() { return app.studio(); }
  glm::vec2 on_screen(const glm::vec2& viewport_px) { return app->interface().viewport().min + viewport_px; }
  // Of a pixel of the place's camera.
  glm::vec2 screen_of(const glm::vec2& pixel) {
    const Camera shown = studio().viewport().pane_camera();
    const glm::vec2 principal(place_.camera.cx_px, place_.camera.cy_px);
    return on_screen((pixel - principal) * (shown.fy_px / place_.camera.fy_px) +
                     glm::vec2(shown.cx_px, shown.cy_px));
  }
  void click_on_it() {
    click(screen_of(place_.pixel));
    REQUIRE(studio().document().active != 0);
  }
  void click(const glm::vec2& screen, PointerButton button = PointerButton::kLeft) {
    app.click(screen, button);
    REQUIRE(app.settle());
  }
  void go_to(const Camera& camera) {
    studio().apply(GoToCamera{camera});
    REQUIRE(app.settle());
  }
  void turn(float points) {
    const glm::vec2 from = on_screen({80, 250});
    app.drag({from, from + glm::vec2(0.5f * points, 0), from + glm::vec2(points, 0)}, PointerButton::kMiddle);
    REQUIRE(app.settle());
  }
  Labels labels() { return studio().labels(studio().document().active); }
  const ObjectItem& object() { return *studio().document().active_object(); }
  const CutRun& run() { return *studio().cuts().run(studio().document().active); }
  const Image<std::int32_t>& hits() { return studio().viewport().picture()->frames.front()->first_hit; }
  std::string said() { return studio().messages().back().text; }

  // Where the labels show on the screen.
  Mask shown(const Labels& labels) {
    Mask mask(hits().width(), hits().height());
    std::ranges::transform(hits().pixels(), mask.pixels().begin(), [&](std::int32_t g) {
      return g >= 0 && labels[static_cast<std::size_t>(g)] ? kMaskObject : std::uint8_t{0};
    });
    return mask;
  }
  // A point on the screen that lies as deep inside of the object as any, by steps of 4 viewport pixels.
  glm::vec2 inside(const Labels& labels) {
    Mask deep = shown(labels);
    for (Mask next = eroded(deep, 4); count(next) > 0; next = eroded(deep, 4)) deep = std::move(next);
    const auto at = std::ranges::find(deep.pixels(), kMaskObject) - deep.pixels().begin();
    return on_screen(glm::vec2(at % deep.width(), at / deep.width()) + 0.5f);
  }
  // The point on the screen that is `away` or more viewport pixels from the object, the nearest to it.
  glm::vec2 beside(const Labels& labels, int away) {
    const Mask object = shown(labels), near = dilated(object, away), far = dilated(object, away + 3);
    for (int y = hits().height() / 4; y < hits().height(); ++y)
      for (int x = 40; x < hits().width() - 40; ++x)
        if (far.at(x, y) && !near.at(x, y) && hits().at(x, y) >= 0)
          return on_screen(glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f);
    FAIL("there is nothing beside the object");
    return {};
  }

  // Saved, the work reads back the same, and computed again without the window its labels are the same.
  void check_saved_work() {
    const ScratchFolder folder("artist");
    const auto file = folder / "artist.splatcut.json";
    studio().apply(SaveWork{file});
    REQUIRE(app.settle());
    const auto scene = open_scene(read_work_file(file).files);
    Document read = restored(read_work_file(file), *scene).document;
    CHECK(same(read, studio().document()));
    read.objects.front().cut = nullptr;
    const Document again = computed_again(*scene, read);
    CHECK(labels_of(again, *again.active_object(), labels().size()) == labels());
  }

  HeadlessApp app;

 private:
  ClickedPlace place_;
};

inline std::size_t lost(const Labels& before, const Labels& after) {
  std::size_t count = 0;
  for (std::size_t g = 0; g < before.size(); ++g) count += before[g] && !after[g];
  return count;
}

}  // namespace splatcut::testing
