#include "app/document/label_cache.h"

namespace splatcut {

const LabelCache::Kept& LabelCache::kept(const Document& document, const ObjectItem& object,
                                         std::size_t gaussians) {
  constexpr std::size_t kMostGone = 16;  // objects that undo may bring back
  if (kept_.size() > document.objects.size() + kMostGone)
    std::erase_if(kept_, [&](const auto& entry) { return !document.find(entry.first); });
  const ObjectItem* whole = document.find(object.within);
  const Flags limit = whole ? labels(document, *whole, gaussians) : nullptr;
  Kept& kept = kept_[object.id];
  const bool current = kept.labels && kept.labels->size() == gaussians && kept.cut == object.cut &&
                       kept.hand == object.hand && kept.of_others == object.of_others &&
                       kept.deleted == document.deleted && kept.whole == limit;
  if (current) return kept;
  Flags fresh = make_flags(labels_of(document, object, gaussians));
  const std::size_t count = count_flags(*fresh);
  kept = {object.cut, object.hand, object.of_others, document.deleted, limit, std::move(fresh), count};
  return kept;
}

const Flags& LabelCache::labels(const Document& document, const ObjectItem& object, std::size_t gaussians) {
  return kept(document, object, gaussians).labels;
}

std::size_t LabelCache::count(const Document& document, const ObjectItem& object, std::size_t gaussians) {
  return kept(document, object, gaussians).count;
}

Flags known_labels(const Document& document, const ObjectItem& object, std::size_t gaussians,
                   LabelCache* known) {
  return known ? known->labels(document, object, gaussians)
               : make_flags(labels_of(document, object, gaussians));
}

}  // namespace splatcut
