// Random commands on a small scene: never a crash, and undo leads back to the start, redo to the end,
// exactly.
#include <doctest/doctest.h>

#include <random>
#include <thread>

#include "app/studio/studio.h"
#include "headless_app.h"

#include "quick.h"
#include "random_scene.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

class Fuzz {
 public:
  Fuzz(Studio* studio, unsigned seed) : studio_(*studio), random_(seed) {}

  void step() {
    const Document& d = studio_.document();
    const auto object = [&]() -> ObjectId {
      return d.objects.empty() || chance(20) ? static_cast<ObjectId>(whole(6))
                                             : d.objects[whole(d.objects.size())].id;
    };
    const auto set = [&] { return static_cast<SetOperation>(whole(3)); };
    switch (whole(36)) {
      case 0:
      case 1:
      case 2:
        return studio_.apply(AddStroke{camera(), stroke()});
      case 3:
        return studio_.apply(AddBox{camera(), pixel(), pixel()});
      case 4:
        return studio_.apply(SelectRegion{camera(), rectangle_region(pixel(), pixel(), 64, 48), set()});
      case 5:
        return studio_.apply(
            SelectVolume{{chance(50), {real() - 0.5f, real() - 0.5f, real() - 0.5f}, glm::vec3(real())},
                         set(),
                         chance(50)});
      case 6:
        return studio_.apply(SelectColour{{real(), real(), real()}, 0.4f * real(), set()});
      case 7:
        return studio_.apply(
            SelectRange{static_cast<Property>(whole(3)), real() - 0.5f, real() + 0.3f, set()});
      case 8:
      case 9:
        return studio_.apply(EditSelection{static_cast<SelectionEdit>(whole(7))});
      case 10:
        return studio_.apply(ShowFloaters{chance(50)});
      case 11:
        return studio_.apply(StepScale{chance(50) ? 1 : -1});
      case 12:
        return chance(30) ? studio_.apply(ClearStrokes{}) : studio_.apply(some_stroke_away());
      case 13:
        return studio_.apply(NewObject{chance(30) ? object() : 0});
      case 14:
        return chance(40) ? studio_.apply(RemoveObject{object()}) : studio_.apply(Redo{});
      case 15:
        return studio_.apply(RenameObject{object(), chance(10) ? "" : "name " + std::to_string(whole(9))});
      case 16:
        return studio_.apply(RecolourObject{object(), Rgb8{static_cast<std::uint8_t>(whole(256)), 7, 9}});
      case 17:
        return chance(50)
                   ? studio_.apply(TintObject{object(), chance(70)})
                   : studio_.apply(SetView{turned_eye(studio_.view(), object(), studio_.document().active)});
      case 18:
        return studio_.apply(LockObject{object(), chance(25)});
      case 19:
        return studio_.apply(ActivateObject{object()});
      case 20:
        return chance(50) ? studio_.apply(MergeObjects{object(), object()})
                          : studio_.apply(SplitObject{object()});
      case 21:
        return studio_.apply(DuplicateObject{object()});
      case 22:
        return chance(50) ? studio_.apply(SeparateObject{object()})
                          : studio_.apply(LeaveToOthers{object(), chance(70)});
      case 23:
        return chance(30) ? studio_.apply(DeleteSelected{}) : studio_.apply(RestoreDeleted{});
      case 24:
        return studio_.apply(LeaveOutView{object(), view(), chance(60)});
      case 25:
        return studio_.apply(SetSmoothness{object(), 20 * real() - 1});
      case 26:
        return studio_.apply(SetPreset{std::array{"default", "paper", "paper-code", "none"}[whole(4)]});
      case 27:
        return studio_.apply(SetUp{{real() - 0.5f, real() - 0.5f, chance(5) ? 0.0f : real() - 0.5f}});
      case 28:
        return chance(97) ? studio_.apply(Undo{})
                          : studio_.apply(JumpHistory{whole(studio_.history().entries().size() + 2)});
      case 30:
        return studio_.apply(PickColour{static_cast<std::int32_t>(whole(3000)) - 5, set()});
      case 31:
        return studio_.apply(SelectFlood{static_cast<std::int32_t>(whole(3000)) - 5, set()});
      case 32:
        return studio_.apply(LookAlong{{real() - 0.5f, real() - 0.5f, chance(10) ? 0 : real()}});
      case 33:
        return chance(50) ? studio_.apply(NextBackdrop{}) : studio_.apply(SetBackdrop{whole(6)});
      case 34:
        return studio_.apply(ComeNearer{});
      case 35:
        return studio_.apply(IntersectStroke{camera(), stroke()});
      default:
        return studio_.apply(SetBackground{{real(), real(), real()}});
    }
  }

  std::size_t whole(std::size_t below) { return random_() % below; }

 private:
  float real() { return static_cast<float>(random_() >> 8) / 16777216.0f; }
  bool chance(unsigned percent) { return random_() % 100 < percent; }
  glm::vec2 pixel() { return {64 * real(), 48 * real()}; }
  Camera camera() { return front_camera(64, 48); }
  // Mostly one that the cut looked from.
  Camera view() {
    const CutRun* run = studio_.cuts().run(studio_.document().active);
    return run && !run->views.empty() && chance(80) ? run->views[whole(run->views.size())].camera : camera();
  }
  // Mostly of one that is there, whatever stroke it is.
  RemoveStroke some_stroke_away() {
    const ObjectItem* active = studio_.document().active_object();
    if (!active || active->views.empty() || chance(10)) return {whole(3), whole(3), pixel()};
    const std::size_t v = whole(active->views.size()), s = whole(active->views[v].strokes.size());
    return {v, s, active->views[v].strokes[s].points_px.front()};
  }
  Stroke stroke() {
    Stroke s = click(pixel(), chance(60) ? SeedLabel::kObject : SeedLabel::kRest);
    for (std::size_t i = whole(4); i > 0; --i) s.points_px.push_back(pixel());
    return s;
  }

  Studio& studio_;
  std::mt19937 random_;
};

}  // namespace

QUICK_CASE("task thread", "threads: random commands while they work, and an end in the middle of it") {
  const ScratchFolder folder("threads");
  write_random_scene(folder / "random.ply");
  for (unsigned seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    StudioOptions options;
    options.state_folder = folder / "state";
    Studio studio(options);
    studio.set_viewport(64, 48, 1);
    studio.apply(OpenScene{folder / "random.ply"});
    REQUIRE(studio.settle(120));
    Fuzz fuzz(&studio, seed);
    for (int i = 0; i < 150; ++i) {
      fuzz.step();
      if (i % 7 == 0) studio.camera().orbit({3, 1});
      if (i % 31 == 0) studio.apply(Cancel{});
      studio.update(1.0 / 10);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    REQUIRE(studio.settle(120));
    const Document end = studio.document();
    const std::size_t cursor = studio.history().cursor();
    while (studio.history().can_undo()) studio.apply(Undo{});
    CHECK(studio.document().objects.empty());
    for (std::size_t i = 0; i < cursor; ++i) studio.apply(Redo{});
    REQUIRE(studio.settle(120));
    CHECK(same(studio.document(), end));
    studio.apply(AddStroke{front_camera(64, 48), click({32, 24}, SeedLabel::kObject)});
    studio.update(1.0 / 60);  // a cut and a picture run as the studio ends
  }
}

TEST_CASE("10,000 random commands, undone to the start and redone to the end") {
  const ScratchFolder folder("fuzz");
  write_random_scene(folder / "random.ply");
  StudioOptions options;
  options.inline_tasks = true;
  Studio studio(options);
  studio.set_viewport(64, 48, 1);
  studio.apply(OpenScene{folder / "random.ply"});
  REQUIRE(studio.scene());
  const Document start = studio.document();
  constexpr unsigned kSeed = 2024;
  CAPTURE(kSeed);
  Fuzz fuzz(&studio, kSeed);
  constexpr int kSteps = 10000, kCuts = 25;
  for (int i = 0; i < kSteps; ++i) {
    fuzz.step();
    if (i % (kSteps / kCuts) == 0) studio.update(1.0 / 60);  // cuts what is stale
    while (studio.waiting()) studio.update(1.0 / 60);
    while (studio.document().objects.size() > 12) {
      studio.apply(LockObject{studio.document().objects.front().id, false});
      studio.apply(RemoveObject{studio.document().objects.front().id});
    }
  }
  const Document end = studio.document();
  MESSAGE("history: " << studio.history().entries().size() << " steps");
  const std::size_t cursor = studio.history().cursor();
  while (studio.history().can_undo()) studio.apply(Undo{});
  Document back = studio.document();
  back.background = start.background;  // is no work: it stays
  CHECK(same(back, start));
  for (std::size_t i = 0; i < cursor; ++i) studio.apply(Redo{});
  CHECK(same(studio.document(), end));
}
