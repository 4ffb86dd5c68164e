// The size of a file that is not written yet, as the export dialog says it.
#include <doctest/doctest.h>

#include <chrono>

#include "places.h"
#include "scene/formats/losses.h"
#include "scene/still_life/still_life.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

void check_planned_sizes(const Scene& scene) {
  const Folder folder;
  for (const SceneFormat& format : written_formats()) {
    const auto start = std::chrono::steady_clock::now();
    const FormatPlan plan = format.plan(scene, all_gaussians(scene.cloud), true);
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const auto path = folder / (std::string("a") + format.extension);
    const auto bytes = static_cast<double>(save_scene(path, scene, {}, format).bytes);
    const double of_true = static_cast<double>(plan.bytes) / bytes;
    MESSAGE(std::string(format.name), " of ", scene.cloud.size(), ", degree ", scene.cloud.sh_degree, ": ",
            of_true, " of its bytes, in ", ms, " ms");
    const bool text = std::string_view(format.name) == "usda";  // numbers are as long as they need
    CHECK(of_true == doctest::Approx(1).epsilon(text ? 0.25 : plan.about ? 0.2 : 0.05));
  }
}

}  // namespace

TEST_CASE("planned sizes: of the sample and of still lifes every format's is right within a fifth") {
  Scene sample = load_scene(project_folder() + "/assets/sample/sample.compressed.ply");
  sample.rows_can_be_copied = false;
  check_planned_sizes(sample);
  for (const int degree : {0, 3}) {
    StillLifeOptions options;
    options.gaussians = 90'000;  // more than a .sog has sets of spherical harmonics
    options.sh_degree = degree;
    Scene scene;
    scene.cloud = make_still_life(options).cloud;
    check_planned_sizes(scene);
  }
}
