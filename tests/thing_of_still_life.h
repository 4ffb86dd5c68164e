// A scene of the generator, one of its things as the object.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "app/measure/evaluate.h"
#include "scene/still_life/still_life.h"
#include "segment/finish/clean.h"

namespace splatcut::testing {

struct Thing {
  LabelledScene scene;
  EvaluationCase test;

  Thing(const StillLifeOptions& options, const std::string& name) : scene(make_still_life(options)) {
    const auto label = std::ranges::find(scene.label_name, name) - scene.label_name.begin();
    test.name = name;
    test.cloud = &scene.cloud;
    for (std::size_t g = 0; g < scene.label.size(); ++g) {
      test.truth_labels.push_back(scene.label[g] == label);
      test.own_labels.push_back(test.truth_labels[g] & scene.own[g]);
    }
    for (std::size_t c = 1; c < scene.cameras.size(); c += 6)
      test.test_views.push_back(limited_to_width(scene.cameras[c], 320));
    test.reference = test.test_views.front();
    render_truth(&test);
  }

  CleanObject clean(const std::vector<std::uint8_t>& labels, bool rest = false, const Job& job = {}) const {
    return clean_object({scene.cloud, labels, {0, -1, 0}, scene.cameras, rest}, {}, job);
  }
  CleanObject clean() const { return clean(test.truth_labels); }

  GaussianCloud as_labelled() const { return rest_of(scene.cloud, test.truth_labels, {}); }
};

}  // namespace splatcut::testing
