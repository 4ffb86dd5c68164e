#include "app/studio/history.h"

#include <algorithm>
#include <cassert>
#include <unordered_set>

namespace splatcut {

namespace {

// Oldest steps are forgotten when the arrays that only the history holds would take more than this.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;

std::size_t distinct_bytes(const std::vector<History::Entry>& entries) {
  std::unordered_set<const void*> seen;
  std::size_t bytes = 0;
  const auto add = [&](const Flags& flags) {
    if (flags && seen.insert(flags.get()).second) bytes += flags->size();
  };
  for (const History::Entry& entry : entries) {
    add(entry.document.deleted);
    for (const ObjectItem& object : entry.document.objects) {
      add(object.cut);
      add(object.hand);
      for (const StrokedView& view : object.views) add(view.seen);
    }
  }
  return bytes;
}

}  // namespace

void History::reset(Document document, std::string title) {
  entries_.clear();
  entries_.push_back({std::move(title), {}, std::move(document)});
  cursor_ = 0;
  merging_ = false;
}

bool History::merges(std::string_view merge_key) const {
  return merging_ && !merge_key.empty() && entries_[cursor_].merge_key == merge_key && cursor_ > 0;
}

void History::push(std::string title, Document after, std::string merge_key) {
  entries_.resize(cursor_ + 1);
  if (merges(merge_key)) {
    entries_.back() = {std::move(title), std::move(merge_key), std::move(after)};
  } else {
    entries_.push_back({std::move(title), std::move(merge_key), std::move(after)});
    ++cursor_;
  }
  merging_ = true;
  constexpr std::size_t kCheckEvery = 64;  // counting walks the whole history
  if (entries_.size() % kCheckEvery == 0) forget_oldest();
}

void History::forget_oldest() {
  while (cursor_ > 1 && distinct_bytes(entries_) > kMostBytes) {
    entries_.erase(entries_.begin());
    --cursor_;
  }
}

void History::undo() {
  assert(can_undo());
  --cursor_;
  merging_ = false;
}

void History::redo() {
  assert(can_redo());
  ++cursor_;
  merging_ = false;
}

void History::jump(std::size_t entry) {
  assert(entry < entries_.size());
  cursor_ = entry;
  merging_ = false;
}

void History::set_cut(ObjectId object, const std::string& cut_key, const Flags& labels) {
  for (Entry& entry : entries_) {
    ObjectItem* item = entry.document.find(object);
    if (!item || splatcut::cut_key(entry.document, *item) != cut_key) continue;
    item->cut = labels;
    item->cut_key = cut_key;
  }
}

}  // namespace splatcut
