#include "app/document/clean_objects.h"

#include <algorithm>

#include "segment/finish/shown_part.h"

namespace splatcut {

std::shared_ptr<const CleanObject> CleanObjects::known(const Flags& labels, const glm::vec3& up_world) const {
  const std::lock_guard lock(mutex_);
  const Flags own = first(labels);
  const bool forced = anyway(own);
  const auto found = std::ranges::find_if(
      kept_, [&](const Kept& k) { return k.up_world == up_world && k.anyway == forced && k.labels == own; });
  return found == kept_.end() ? nullptr : found->object;
}

std::shared_ptr<const CleanObject> CleanObjects::made(const Flags& labels, const glm::vec3& up_world,
                                                      const Job& job) {
  if (auto object = known(labels, up_world)) return object;
  const bool forced = is_cleaned_anyway(labels);
  auto object = std::make_shared<const CleanObject>(computed(labels, up_world, false, forced, job));
  if (job.cancelled()) return nullptr;
  constexpr std::size_t kMost = 4;
  const std::lock_guard lock(mutex_);
  kept_.push_back({first(labels), up_world, forced, object});
  if (kept_.size() > kMost) kept_.pop_front();
  return object;
}

std::shared_ptr<const SceneWithout> CleanObjects::known_without(const Leaving& leaving) const {
  const std::lock_guard lock(mutex_);
  Leaving own = leaving;
  own.labels = first(leaving.labels);
  const bool forced = own.clean_edges && anyway(own.labels);
  const auto found = std::ranges::find_if(
      kept_without_, [&](const KeptWithout& k) { return k.leaving == own && k.anyway == forced; });
  return found == kept_without_.end() ? nullptr : found->without;
}

std::shared_ptr<const SceneWithout> CleanObjects::made_without(const Leaving& leaving, const Job& job) {
  if (auto without = known_without(leaving)) return without;
  auto made = std::make_shared<SceneWithout>();
  const bool forced = leaving.clean_edges && is_cleaned_anyway(leaving.labels);
  if (leaving.clean_edges) {
    CleanObject object = computed(leaving.labels, leaving.up_world, true, forced, job);
    made->edges = std::move(object.report);
    made->changes = std::move(object.rest);
  }
  if (leaving.fill_hole && !job.cancelled()) made->patch = hole_of(leaving, made->changes, job);
  if (job.cancelled()) return nullptr;
  constexpr std::size_t kMost = 2;
  const std::lock_guard lock(mutex_);
  kept_without_.push_back({leaving, forced, made});
  kept_without_.back().leaving.labels = first(leaving.labels);
  if (kept_without_.size() > kMost) kept_without_.pop_front();
  return made;
}

void CleanObjects::clean_anyway(const Flags& labels) {
  const std::lock_guard lock(mutex_);
  const Flags own = first(labels);
  std::erase(anyway_, own);
  anyway_.push_back(own);
  if (anyway_.size() > kMostDecisions) anyway_.erase(anyway_.begin());
}

bool CleanObjects::is_cleaned_anyway(const Flags& labels) const {
  const std::lock_guard lock(mutex_);
  return anyway(first(labels));
}

std::vector<Flags> CleanObjects::decisions() const {
  const std::lock_guard lock(mutex_);
  return anyway_;
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
  for (const auto& asked : asked_) compare(asked.second.lock());
  for (const Kept& kept : kept_) compare(kept.labels);
  for (const Flags& own : anyway_) compare(own);
  for (const KeptWithout& kept : kept_without_) compare(kept.leaving.labels);
  asked_.emplace_back(labels, found);
  if (asked_.size() > kMostAsked) asked_.pop_front();
  return found;
}

bool CleanObjects::anyway(const Flags& first) const {
  return std::ranges::find(anyway_, first) != anyway_.end();
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

CleanObject CleanObjects::computed(const Flags& labels, const glm::vec3& up_world, bool rest, bool anyway,
                                   const Job& job) const {
  return clean_object({Drawer(*scene_->cloud, nullptr, scene_->blocks.get()), *labels, up_world,
                       scene_->views().cameras, rest, anyway},
                      {}, job);
}

}  // namespace splatcut
