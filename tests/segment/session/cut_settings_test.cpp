// The settings by name, and the weights of the fitted model: each read as it is written, none twice.
#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "core/error.h"
#include "segment/session/local_session.h"
#include "segment/session/settings_table.h"
#include "segment/superpoints/part_model.h"
#include "segment/superpoints/prepared_scene.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

TEST_CASE("settings: what they say they take what they give, in every preset") {
  std::set<std::string> names;
  for (const Setting& setting : settings_table()) {
    CAPTURE(setting.name);
    CHECK(names.insert(setting.name).second);
    CHECK_FALSE(setting.sentence.empty());
    for (const Preset& preset : presets()) {
      CutSettings copy;
      REQUIRE(setting.set(setting.get(preset.settings()), &copy));
      CHECK(setting.get(copy) == setting.get(preset.settings()));
    }
  }
}

TEST_CASE("settings: their defaults are the default preset, and differences make any other") {
  CHECK(CutSettings{} == preset("default"));
  for (const Preset& preset : presets()) {
    CAPTURE(preset.name);
    CutSettings made;
    for (const std::string& assignment : differences(preset.settings(), {})) set_setting(assignment, &made);
    CHECK(differences(made, preset.settings()).empty());
    CHECK(made == preset.settings());
  }
}

TEST_CASE("settings: what is out of range is refused with name, value and range") {
  const auto refused = [](const auto& change, std::initializer_list<const char*> says) {
    CutSettings settings;
    change(settings);
    try {
      check(settings);
      FAIL("was taken");
    } catch (const Error& error) {
      for (const char* word : says)
        CHECK_MESSAGE(std::string(error.what()).find(word) != std::string::npos, error.what());
    }
  };
  refused([](CutSettings& s) { s.work_width_px = 3; }, {"work_width_px", "3", "from 32 to 8192"});
  refused([](CutSettings& s) { s.smoothness = 501.0f; }, {"smoothness", "501", "from 0 to 500"});
  refused([](CutSettings& s) { s.cut.energy.lambda = -1; }, {"energy.lambda", "-1", "from 0 to 500"});
  refused([](CutSettings& s) { s.parts_only = true, s.first_mask_from = FirstMaskFrom::kPixels; },
          {"parts_only", "pixels"});
  for (const Preset& preset : presets()) check(preset.settings());
}

TEST_CASE("part model: each weight has a name of its own and is what was set") {
  std::set<std::string> names;
  const PartModel shipped;
  for (const PartWeight& weight : part_weights()) {
    CAPTURE(weight.name);
    CHECK(names.insert(weight.name).second);
    PartModel model;
    weight.set(&model, 7);
    CHECK(weight.get(model) == 7);
    for (const PartWeight& other : part_weights())
      if (other.name != weight.name) CHECK(other.get(model) == other.get(shipped));
  }
  // Each is in the table: floats and whole numbers of four bytes, nothing else.
  CHECK(part_weights().size() * 4 == sizeof(PartModel));
}

TEST_CASE("settings: a cut has as many neighbours a Gaussian as its preset says, paper-code nine") {
  constexpr std::size_t kGaussians = 60;
  const auto cloud = std::make_shared<const GaussianCloud>(random_cloud(kGaussians, 3));
  LocalSession session({.cloud = cloud, .prepared = std::make_shared<const PreparedScene>(), .capture = {}});
  for (const auto& [name, neighbours] :
       {std::pair<const char*, std::size_t>("default", 10), {"paper-code", 9}, {"paper", 10}}) {
    CAPTURE(name);
    const FlowGraph& graph = session.graph(preset(name));
    CHECK(graph.listed == neighbours);
    for (std::size_t g = 0; g < kGaussians; ++g) {
      std::vector<std::pair<float, std::uint32_t>> others;
      for (std::uint32_t h = 0; h < kGaussians; ++h)
        if (h != g) others.emplace_back(glm::distance(cloud->position[g], cloud->position[h]), h);
      std::ranges::sort(others);
      std::set<std::uint32_t> nearest, listed;
      for (std::size_t i = 0; i < neighbours; ++i) {
        nearest.insert(others[i].second);
        listed.insert(graph.head[graph.first_arc[g] + i]);
      }
      CHECK(listed == nearest);
    }
  }
}
