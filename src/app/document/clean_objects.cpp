#include "app/document/clean_objects.h"

#include <algorithm>

#include "segment/finish/shown_part.h"

namespace splatcut {

std::shared_ptr<const CleanObject> CleanObjects::known(const Flags& labels, const glm::vec3& up_world) const {
  const std::lock_guard lock(mutex_);
  const Flags own = first(labels);
  const auto found =
      std::ranges::find_if(kept_, [&](const Kept& k) { return k.up_world == up_world && k.labels == own; });
  return found == kept_.end() ? nullptr : found->object;
}

std::shared_ptr<const CleanObject> CleanObjects::made(const Flags& labels, const glm::vec3& up_world,
                                                      const Job& job) {
  if (auto object = known(labels, up_world)) return object;
  auto object = std::make_shared<const CleanObject>(computed(labels, up_world, false, job));
  if (job.cancelled()) return nullptr;
  constexpr std::size_t kMost = 4;
  const std::lock_guard lock(mutex_);
  kept_.push_back({first(labels), up_world, object});
  if (kept_.size() > kMost) kept_.pop_front();
  return object;
}

std::shared_ptr<const SceneWithout> CleanObjects::known_without(const Leaving& leaving) const {
  const std::lock_guard lock(mutex_);
  Leaving own = leaving;
  own.labels = first(leaving.labels);
  const auto found =
      std::ranges::find_if(kept_without_, [&](const KeptWithout& k) { return k.leaving == own; });
  return found == kept_without_.end() ? nullptr : found->without;
}

std::shared_ptr<const SceneWithout> CleanObjects::made_without(const Leaving& leaving, const Job& job) {
  if (auto without = known_without(leaving)) return without;
  auto made = std::make_shared<SceneWithout>();
  if (leaving.clean_edges) {
    CleanObject object = computed(leaving.labels, leaving.up_world, true, job);
    made->edges = std::move(object.report);
    made->changes = std::move(object.rest);
  }
  if (leaving.fill_hole && !job.cancelled()) made->patch = hole_of(leaving, made->changes, job);
  if (job.cancelled()) return nullptr;
  constexpr std::size_t kMost = 2;
  const std::lock_guard lock(mutex_);
  kept_without_.push_back({leaving, made});
  kept_without_.back().leaving.labels = first(leaving.labels);
  if (kept_without_.size() > kMost) kept_without_.pop_front();
  return made;
}

Flags CleanObjects::first(const Flags& labels) const {
  constexpr std::size_t kMostAsked = 2 * kMostObjects;  // the export dialog asks for each in every frame
  for (const auto& [asked, own] : asked_)
    if (!asked.owner_before(labels) && !labels.owner_before(asked))
      if (Flags known = own.lock()) return known;
  Flags found = labels;
  const auto compare = [&](const Flags& other) {
    if (found == labels && *other == *labels) found = other;
  };
  std::erase_if(asked_, [](const auto& asked) { return asked.first.expired() || asked.second.expired(); });
  for (const auto& asked : asked_)
    if (const Flags own = asked.second.lock()) compare(own);  // other threads let go of labels at any time
  for (const Kept& kept : kept_) compare(kept.labels);
  for (const KeptWithout& kept : kept_without_) compare(kept.leaving.labels);
  asked_.emplace_back(labels, found);
  if (asked_.size() > kMostAsked) asked_.pop_front();
  return found;
}

// In the scene so changed.
SurfacePatch CleanObjects::hole_of(const Leaving& leaving, const RestChanges& changes, const Job& job) const {
  std::vector<std::uint32_t> gone = changes.ghosts;
  if (leaving.deleted) {
    const std::vector<std::uint32_t> deleted = labelled_rows(*leaving.deleted);
    gone.insert(gone.end(), deleted.begin(), deleted.end());
  }
  return fill_surface(Drawer(*scene_->cloud, nullptr, scene_->blocks.get()), *leaving.labels, gone,
                      leaving.up_world, scene_->views().cameras, job);
}

CleanObject CleanObjects::computed(const Flags& labels, const glm::vec3& up_world, bool rest,
                                   const Job& job) const {
  return clean_object({Drawer(*scene_->cloud, nullptr, scene_->blocks.get()), *labels, up_world,
                       scene_->views().cameras, rest},
                      {}, job);
}

}  // namespace splatcut
