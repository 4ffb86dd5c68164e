#include "app/document/seen_object.h"

#include <algorithm>
#include <bit>

namespace splatcut {

SeenQuestion question_of(const ViewState& view, const Flags& labels, const glm::vec3& up_world) {
  const bool hides = view.display == DisplayMode::kHide && !view.fill_hole;
  return {shows_seen_heat(view) ? SeenWhat::kHeat
          : hides               ? SeenWhat::kGround
                                : SeenWhat::kNothing,
          labels, up_world};
}

bool SeenObject::answers(const SeenQuestion& question) const {
  return is_of(question.labels, question.up_world) &&
         (question.what == SeenWhat::kHeat ? heat != nullptr : ground != nullptr);
}

std::shared_ptr<const SeenObject> seen_object(const SeenQuestion& question, const SeenObject* known,
                                              const OpenedScene& scene, const Job& job) {
  const auto& [what, labels, up_world] = question;
  auto seen = std::make_shared<SeenObject>();
  if (known && known->is_of(labels, up_world)) *seen = *known;
  seen->labels = labels;
  seen->up_world = up_world;
  const Drawer drawer(*scene.cloud, nullptr, scene.blocks.get());
  const std::vector<Camera>& cameras = scene.views().cameras;
  if (what == SeenWhat::kHeat)
    seen->heat = std::make_shared<const std::vector<float>>(
        heat_of(seen_by_views(drawer, *labels, up_world, cameras, job), *labels));
  else
    seen->ground =
        std::make_shared<const UnseenGround>(unseen_ground(drawer, *labels, up_world, cameras, job));
  return seen;
}

std::vector<float> heat_of(const SeenFrom& seen, const std::vector<std::uint8_t>& labels) {
  const float many = 0.5f * static_cast<float>(seen.views.size());
  std::vector<float> heat(labels.size(), 0.0f);
  std::size_t own = 0;
  for (std::size_t g = 0; g < labels.size(); ++g)
    if (labels[g]) {
      const auto by = static_cast<float>(std::popcount(seen.by_views.at(own++)));
      heat[g] = many > 0 ? std::clamp(1 - by / many, 0.0f, 1.0f) : 1.0f;
    }
  return heat;
}

}  // namespace splatcut
