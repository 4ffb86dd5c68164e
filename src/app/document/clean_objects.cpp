#include "app/document/clean_objects.h"

#include <algorithm>

namespace splatcut {

std::shared_ptr<const CleanObject> CleanObjects::known(const std::vector<std::uint8_t>& labels,
                                                       const glm::vec3& up_world) const {
  const std::lock_guard lock(mutex_);
  const bool forced = anyway(labels);
  const auto found = std::ranges::find_if(kept_, [&](const Kept& k) {
    return k.up_world == up_world && k.anyway == forced && k.labels == labels;
  });
  return found == kept_.end() ? nullptr : found->object;
}

std::shared_ptr<const CleanObject> CleanObjects::made(const std::vector<std::uint8_t>& labels,
                                                      const glm::vec3& up_world, const Job& job) {
  if (auto object = known(labels, up_world)) return object;
  const bool forced = is_cleaned_anyway(labels);
  auto object = std::make_shared<const CleanObject>(computed(labels, up_world, false, forced, job));
  if (job.cancelled()) return nullptr;
  constexpr std::size_t kMost = 4;
  const std::lock_guard lock(mutex_);
  kept_.push_back({labels, up_world, forced, object});
  if (kept_.size() > kMost) kept_.pop_front();
  return object;
}

RestChanges CleanObjects::rest_without(const std::vector<std::uint8_t>& labels, const glm::vec3& up_world,
                                       const Job& job) const {
  return computed(labels, up_world, true, is_cleaned_anyway(labels), job).rest;
}

void CleanObjects::clean_anyway(const std::vector<std::uint8_t>& labels) {
  const std::lock_guard lock(mutex_);
  if (!anyway(labels)) anyway_.push_back(labels);
}

bool CleanObjects::is_cleaned_anyway(const std::vector<std::uint8_t>& labels) const {
  const std::lock_guard lock(mutex_);
  return anyway(labels);
}

bool CleanObjects::anyway(const std::vector<std::uint8_t>& labels) const {
  return std::ranges::find(anyway_, labels) != anyway_.end();
}

SurfacePatch CleanObjects::hole_of(const std::vector<std::uint8_t>& labels, const RestChanges& changes,
                                   const glm::vec3& up_world, const Job& job) const {
  return fill_surface(Drawer(*scene_->cloud, nullptr, scene_->blocks.get()), labels, changes.ghosts, up_world,
                      scene_->views().cameras, job);
}

CleanObject CleanObjects::computed(const std::vector<std::uint8_t>& labels, const glm::vec3& up_world,
                                   bool rest, bool anyway, const Job& job) const {
  return clean_object({Drawer(*scene_->cloud, nullptr, scene_->blocks.get()), labels, up_world,
                       scene_->views().cameras, rest, anyway},
                      {}, job);
}

}  // namespace splatcut
