#include "app/work/work_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>
#include <utility>

#include "app/work/work_document.h"
#include "app/work/work_values.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

using nlohmann::json;

namespace {

constexpr std::size_t kMostArrayBytes = std::size_t{64} << 20, kMostNumbers = 4'000'000;

// The labels that a cut computes again are not kept; what is locked is not cut again.
Document without_cuts(Document document, const auto& keeps_too) {
  const Document all = document;
  for (ObjectItem& o : document.objects)
    if (!o.cut_kept && !(o.locked && is_stale(all, o)) && !keeps_too(o)) {
      o.cut = nullptr;
      o.cut_key.clear();
    }
  return document;
}

Document without_cuts(const Document& document) {
  return without_cuts(document, [](const ObjectItem&) { return false; });
}

// The next undo and redo wait for no cut. Labels that are those of `now` come from there, see
// History::reset().
Document next_to(const Document& now, const Document& document) {
  return without_cuts(document, [&](const ObjectItem& o) {
    const ObjectItem* known = now.find(o.id);
    return !is_stale(document, o) && !(known && known->cut_key == o.cut_key);
  });
}

std::set<const void*> arrays_of(const Document& document) {
  std::set<const void*> arrays;
  const auto add = [&](const Flags& flags) {
    if (flags) arrays.insert(flags.get());
  };
  add(document.deleted);
  for (const ObjectItem& o : document.objects) {
    for (const Flags& flags : {o.cut, o.hand, o.of_others, o.among}) add(flags);
    for (const StrokedView& view : o.views) add(view.seen);
  }
  return arrays;
}

// Each array once, by number; whether there is room is said before it is needed.
class ArrayTable {
 public:
  explicit ArrayTable(const Scene& scene) : scene_(scene) {}

  bool has_room_for(const Document& document) const {
    const auto added = std::ranges::count_if(arrays_of(document),
                                             [&](const void* array) { return !numbers_.contains(array); });
    return length_ < kMostNumbers && fit(numbers_.size() + static_cast<std::size_t>(added));
  }
  bool fit(std::size_t arrays) const {
    return arrays * std::max<std::size_t>(scene_.file_rows, 1) <= kMostArrayBytes;
  }
  json number_of(const Flags& flags) {
    if (!flags) return nullptr;
    const auto [at, fresh] = numbers_.emplace(flags.get(), numbers_.size());
    if (fresh) {
      arrays_.push_back(runs_json(flags, scene_));
      length_ += arrays_.back().size();
    }
    return at->second;
  }
  json take() { return std::exchange(arrays_, json::array()); }

 private:
  const Scene& scene_;
  std::unordered_map<const void*, std::size_t> numbers_;
  json arrays_ = json::array();
  std::size_t length_ = 0;
};

// An object that is as it was in the step next to it stands there once.
class ObjectTable {
 public:
  json number_of(json object) {
    const auto id = object.at("id").get<ObjectId>();
    const auto known = last_.find(id);
    if (known != last_.end() && objects_[known->second] == object) return known->second;
    last_[id] = objects_.size();
    objects_.push_back(std::move(object));
    return objects_.size() - 1;
  }
  json take() { return std::exchange(objects_, json::array()); }

 private:
  std::unordered_map<ObjectId, std::size_t> last_;
  json objects_ = json::array();
};

}  // namespace

SavedSteps saved_steps(const History& history) {
  const std::vector<History::Entry>& entries = history.entries();
  std::size_t begin = history.cursor(), end = history.cursor() + 1;
  while (begin > 0 && end - begin <= kMostSavedSteps / 2) --begin;
  while (end < entries.size() && end - begin < kMostSavedSteps) ++end;
  SavedSteps out;
  out.cursor = history.cursor() - begin;
  for (std::size_t i = begin; i < end; ++i)
    out.steps.push_back({entries[i].title, entries[i].document, entries[i].other_files != 0});
  for (const ObjectItem& object : history.now().objects) {
    const Document* before = before_last_stroke(history, object.id);
    for (std::size_t i = begin; i < end; ++i)
      if (before == &entries[i].document) out.compared.push_back(i - begin);
  }
  return out;
}

json history_json(const SavedSteps& history, const Scene& scene) {
  ArrayTable arrays(scene);
  ObjectTable objects;
  std::vector<Document> kept;
  std::set<const void*> expected;
  for (const SavedSteps::Step& step : history.steps) {
    kept.push_back(without_cuts(step.document));
    expected.merge(arrays_of(kept.back()));
  }
  // What can be computed again has what room all steps together leave.
  std::vector<std::size_t> with_all = {history.cursor + 1, history.cursor - 1};
  with_all.insert(with_all.end(), history.compared.begin(), history.compared.end());
  for (const std::size_t next : with_all) {
    if (next >= kept.size()) continue;  // also before the first
    Document with_labels = next_to(history.steps[history.cursor].document, history.steps[next].document);
    std::set<const void*> with = arrays_of(with_labels);
    with.insert(expected.begin(), expected.end());
    if (!arrays.fit(with.size())) continue;
    kept[next] = std::move(with_labels);
    expected = std::move(with);
  }
  const auto step_json = [&](std::size_t i) {
    const SavedSteps::Step& step = history.steps[i];
    json out = document_json(kept[i], [&](const Flags& flags) { return arrays.number_of(flags); });
    for (json& object : out["objects"]) object = objects.number_of(std::move(object));
    out["title"] = step.title;
    if (step.other_files) out["other_files"] = true;
    return out;
  };
  const auto fits = [&](std::size_t i) { return arrays.has_room_for(kept[i]); };
  std::vector<json> back, on;  // from the cursor
  for (std::size_t i = history.cursor + 1; i-- > 0 && fits(i);) back.push_back(step_json(i));
  if (back.empty()) return nullptr;
  for (std::size_t i = history.cursor + 1; i < history.steps.size() && fits(i); ++i)
    on.push_back(step_json(i));
  json steps = json::array();
  for (auto step = back.rbegin(); step != back.rend(); ++step) steps.push_back(std::move(*step));
  for (json& step : on) steps.push_back(std::move(step));
  return {{"cursor", back.size() - 1},
          {"arrays", arrays.take()},
          {"objects", objects.take()},
          {"steps", std::move(steps)}};
}

SavedSteps history_from(const json& j, const Scene& scene, const Document& document) {
  const json &arrays = j.at("arrays"), &objects = j.at("objects"), &steps = j.at("steps");
  SavedSteps out;
  out.cursor = j.at("cursor");
  if (out.cursor >= steps.size() || steps.size() > kMostSavedSteps)
    throw Error("history", fmt::format("step {} of {}", out.cursor, steps.size()));
  if (arrays.size() * std::max<std::size_t>(scene.file_rows, 1) > kMostArrayBytes)
    throw Error("history", fmt::format("{} arrays of {} rows are too many", arrays.size(), scene.file_rows));
  struct ReadArray {
    Flags flags;
    std::uint8_t largest = 0;
  };
  std::vector<ReadArray> read(arrays.size());  // each once, however many steps name it
  const ReadFlags flags = [&](const json& number, std::uint8_t most) -> Flags {
    if (number.is_null()) return nullptr;
    const json& runs = arrays.at(whole_number(number));
    ReadArray& known = read[whole_number(number)];
    if (!known.flags) {
      known.flags = flags_from(runs, scene, kHandLeft);
      for (const std::uint8_t value : *known.flags) known.largest = std::max(known.largest, value);
    }
    if (known.largest > most)
      throw Error("history", fmt::format("array {} holds more than {}", whole_number(number), most));
    return known.flags;
  };
  for (const json& step : steps) {
    const bool other_files = step.value("other_files", false);  // older work holds no such step
    if (out.steps.size() == out.cursor) {
      out.steps.push_back({step.at("title"), document, other_files});
      continue;
    }
    std::vector<const json*> own;
    for (const json& number : step.at("objects")) own.push_back(&objects.at(whole_number(number)));
    out.steps.push_back({step.at("title"), document_from(step, own, flags), other_files});
  }
  return out;
}

}  // namespace splatcut
