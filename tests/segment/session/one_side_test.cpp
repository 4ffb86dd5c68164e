// A correction changes Gaussians to its own side only: what is added never takes away elsewhere.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "app/measure/robot_user.h"
#include "scene/still_life/still_life.h"
#include "segment/masks/mask_tools.h"
#include "segment/session/session.h"

using namespace splatcut;

namespace {

LabelledScene touching_things_of_one_colour() {
  StillLifeOptions options;
  options.gaussians = 40000;
  options.contact = options.low_contrast = true;
  return make_still_life(options);
}

std::vector<std::uint8_t> true_labels(const LabelledScene& scene, const std::string& name) {
  const auto number = std::ranges::find(scene.label_name, name) - scene.label_name.begin();
  std::vector<std::uint8_t> labels(scene.label.size());
  for (std::size_t g = 0; g < labels.size(); ++g) labels[g] = scene.label[g] == number;
  return labels;
}

// How many Gaussians change to the side and to the other.
std::array<std::size_t, 2> changed(const std::vector<std::uint8_t>& before,
                                   const std::vector<std::uint8_t>& after, std::uint8_t side) {
  std::array<std::size_t, 2> count{0, 0};
  for (std::size_t g = 0; g < after.size(); ++g)
    if (before[g] != after[g]) ++count[after[g] == side ? 0 : 1];
  return count;
}

}  // namespace

TEST_CASE("one side: clicks on the object take nothing from it, clicks on the rest add nothing to it") {
  const LabelledScene scene = touching_things_of_one_colour();
  const auto cloud = std::make_shared<const GaussianCloud>(scene.cloud);
  const SessionScene opened{.cloud = cloud, .photographs = scene.cameras};
  Session session(opened);
  std::size_t corrections = 0;
  for (const std::string name : {"apple", "mug", "pot"}) {
    CAPTURE(name);
    const std::vector<std::uint8_t> truth = true_labels(scene, name);
    const auto seed = std::ranges::find(scene.seeds, name, &LabelledScene::SeedClick::object);
    CutRequest request;
    request.strokes = {
        {scene.cameras[static_cast<std::size_t>(seed->camera)], {click(seed->pixel, SeedLabel::kObject)}}};
    CutResult before = session.cut(request, CutSettings());
    for (const std::size_t from : {2, 5, 8, 11}) {
      const Camera& camera = scene.cameras[from];
      const auto pictured = [&](const std::vector<std::uint8_t>& labels) {
        return thresholded(render_labels(*cloud, camera, labels), 0.5f);
      };
      const auto next = robot_click(pictured(truth), pictured(before.labels));
      if (!next) continue;
      request.strokes.push_back({camera, {*next}});
      const CutResult after = session.cut(request, CutSettings());
      const auto [to_its_side, to_the_other] =
          changed(before.labels, after.labels, next->label == SeedLabel::kObject);
      CAPTURE(from);
      CHECK(to_its_side > 0);
      CHECK(to_the_other == 0);
      ++corrections;
      before = after;
    }
    CHECK(before.labels == Session(opened).cut(request, CutSettings()).labels);
    request.strokes.pop_back();
    CHECK(session.cut(request, CutSettings()).labels == Session(opened).cut(request, CutSettings()).labels);
  }
  CHECK(corrections >= 6);
}
