// Long sessions: memory, open files and threads stay as they are. SPLATCUT_SOAK=1000 makes them as long and
// prints them every 50 steps; tests/soak.sh does it.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <malloc.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include "app/studio/studio.h"
#include "headless_app.h"
#include "scene/formats/scene_file.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

// Of this process.
struct Held {
  double memory_mb = 0, heap_mb = 0;  // of the system's pages; in use of what malloc took
  int files = 0, threads = 0;
};

Held held() {
  Held now;
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") status >> now.memory_mb;
    if (word == "Threads:") status >> now.threads;
  }
  constexpr double kMb = 1 << 20;
  now.memory_mb /= 1024;
  now.heap_mb = static_cast<double>(::mallinfo2().uordblks + ::mallinfo2().hblkhd) / kMb;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) ++now.files;
  return now;
}

// TBB starts its workers one by one, as they are asked for, and keeps them: each has begun when this returns.
void start_every_worker() {
  const int workers = tbb::this_task_arena::max_concurrency();
  const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  std::atomic<int> arrived = 0;
  tbb::parallel_for(
      tbb::blocked_range<int>(0, workers, 1),
      [&](const tbb::blocked_range<int>&) {
        ++arrived;
        while (arrived < workers && std::chrono::steady_clock::now() < latest) std::this_thread::yield();
      },
      tbb::simple_partitioner());
}

// TBB starts one more now and then, while another falls asleep; a thread that stays would be one more each
// round.
constexpr int kAnotherWorker = 1;

int steps_asked(int otherwise) {
  const char* asked = std::getenv("SPLATCUT_SOAK");
  return asked ? std::stoi(asked) : otherwise;
}

class Log {
 public:
  explicit Log(const char* what) : what_(what), printed_(std::getenv("SPLATCUT_SOAK") != nullptr) {
    if (printed_) fmt::print("what,step,memory_mb,heap_mb,files,threads,history\n");
  }
  void add(int step, std::size_t history) const {
    const Held now = held();
    if (printed_)
      fmt::print("{},{},{:.1f},{:.1f},{},{},{}\n", what_, step, now.memory_mb, now.heap_mb, now.files,
                 now.threads, history);
    std::fflush(stdout);
  }

 private:
  const char* what_;
  bool printed_;
};

void write_balls(const std::filesystem::path& path, std::size_t gaussians) {
  Scene scene;
  scene.cloud = random_cloud(gaussians, 11, 1);
  scene.file_rows = gaussians;
  scene.format = SceneFormat::kSplat;  // not .ply: rows are written, not copied
  save_scene(path, scene, {}, SceneFormat::kPly);
}

constexpr std::size_t kGaussians = 4000;
constexpr int kEvery = 50,
              kReopened = 250;  // steps; opening anew forgets the history, which takes memory as it should

// One edit, cut, undo, export or picture.
void step(Studio* studio, const ScratchFolder& folder, std::mt19937* random) {
  const auto whole = [&](unsigned below) { return (*random)() % below; };
  const auto pixel = [&] { return glm::vec2(whole(160), whole(120)); };
  const auto camera = [] { return front_camera(160, 120); };
  const auto label = [&] { return whole(3) ? SeedLabel::kObject : SeedLabel::kRest; };
  switch (whole(10)) {
    case 0:
    case 1:
    case 2:
      studio->apply(AddStroke{camera(), click(pixel(), label())});
      break;
    case 3:
      studio->apply(SelectRegion{camera(), rectangle_region(pixel(), pixel(), 160, 120), SetOperation::kAdd});
      break;
    case 4:
      studio->apply(NewObject{});
      break;
    case 5:
      studio->apply(DeleteSelected{});
      break;
    case 6:
    case 7:
      studio->apply(Undo{});
      break;
    case 8: {
      ExportRequest request;
      request.what = ExportWhat::kRest;
      request.path = folder / "rest.ply";
      request.overwrite = true;
      studio->apply(Export{request});
      break;
    }
    default:
      studio->apply(SaveSnapshot{folder / "picture.png"});
  }
  while (studio->document().objects.size() > 6)
    studio->apply(RemoveObject{studio->document().objects.front().id});
  studio->update(1.0 / 60);  // cuts what is stale
}

}  // namespace

TEST_CASE("soak: edits, cuts, undo, exports leave no file open and no thread behind") {
  const ScratchFolder folder("soak");
  write_balls(folder / "balls.ply", kGaussians);
  StudioOptions options;
  options.inline_tasks = true;
  options.state_folder = folder / "state";
  start_every_worker();
  Studio studio(options);
  studio.set_viewport(160, 120, 1);
  studio.apply(OpenScene{folder / "balls.ply"});
  REQUIRE(studio.scene());
  std::mt19937 random(5);
  const Log log("edits");
  const int steps = steps_asked(60);
  Held first;
  for (int i = 0; i <= steps; ++i) {
    if (i > 0 && i % kReopened == 0) studio.apply(OpenScene{folder / "balls.ply"});
    if (i % kEvery == 0) log.add(i, studio.history().entries().size());
    if (i == std::min(kEvery, steps / 2)) first = held();
    step(&studio, folder, &random);
  }
  CHECK(held().files == first.files);
  CHECK(held().threads <= first.threads + kAnotherWorker);
}

TEST_CASE("soak: opened, cut and closed again and again, nothing stays open") {
  const ScratchFolder folder("soak");
  write_balls(folder / "balls.ply", kGaussians);
  start_every_worker();
  const Log log("open, cut, close");
  Held first;
  const int rounds = steps_asked(60) / 10;
  for (int i = 0; i <= rounds; ++i) {
    StudioOptions options;
    // Its own each time: work that a slow round has saved by itself is held open by the next.
    options.state_folder = folder / ("state" + std::to_string(i));
    std::size_t history = 0;
    {
      Studio studio(options);
      studio.set_viewport(160, 120, 1);
      studio.apply(OpenScene{folder / "balls.ply"});
      REQUIRE(studio.settle(120));
      studio.apply(AddStroke{front_camera(160, 120), click({80, 60}, SeedLabel::kObject)});
      REQUIRE(studio.settle(120));
      REQUIRE(!studio.document().objects.empty());
      history = studio.history().entries().size();
    }
    if (i % 5 == 0) log.add(i, history);
    if (i == 1) first = held();
    if (i > 1) CHECK(held().files == first.files);
    if (i > 1) CHECK(held().threads <= first.threads + kAnotherWorker);
    if (i > 1) CHECK(held().heap_mb < first.heap_mb + 4);
  }
}
