#include "app/document/history.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/byte_hash.h"

namespace splatcut {

namespace {

// Oldest steps are forgotten when the arrays that only the history holds would take more than this.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;

// Never the same twice, in whatever history: one that is kept and gone back to has its own numbers for
// itself.
std::uint64_t next_serial() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

template <class DocumentOrConst>
void visit_arrays(DocumentOrConst& document, const auto& visit) {
  visit(document.deleted);
  for (auto& object : document.objects) {
    for (auto* flags : {&object.cut, &object.hand, &object.of_others, &object.among}) visit(*flags);
    for (auto& view : object.views) visit(view.seen);
  }
}

// Makes one of equal arrays, as those are that a step leaves: they are compared by their places.
class SharedArrays {
 public:
  void share(Flags* flags) {
    if (!*flags) return;
    Flags& known = by_place_[*flags];
    if (!known) known = first(*flags);
    *flags = known;
  }

 private:
  Flags first(const Flags& flags) {
    std::vector<Flags>& alike = by_hash_[hash_bytes(std::as_bytes(std::span(*flags)))];
    for (const Flags& other : alike)
      if (*other == *flags) return other;
    return alike.emplace_back(flags);
  }
  std::unordered_map<Flags, Flags> by_place_;
  std::unordered_map<std::uint64_t, std::vector<Flags>> by_hash_;
};

std::size_t distinct_bytes(const std::vector<History::Entry>& entries) {
  std::unordered_set<const void*> seen;
  std::size_t bytes = 0;
  const auto add = [&](const Flags& flags) {
    if (flags && seen.insert(flags.get()).second) bytes += flags->size();
  };
  for (const History::Entry& entry : entries) visit_arrays(entry.document, add);
  return bytes;
}

// Whether a step changed the object, see ObjectKeys for its strokes. Arrays are compared by their places: a
// step that leaves them shares them.
bool is_changed(const History::Entry& before, const History::Entry& after, const ObjectItem& object) {
  const ObjectItem* was = before.document.find(object.id);
  if (!was) return true;
  const auto keys_in = [](const History::Entry& entry, const ObjectItem* item) -> const ObjectKeys& {
    return *entry.keys[static_cast<std::size_t>(item - entry.document.objects.data())];
  };
  const auto plain = [](const ObjectItem& o) {
    return std::tie(o.name, o.colour, o.tinted, o.locked, o.within, o.hand, o.of_others, o.leaves_also);
  };
  return plain(*was) != plain(object) || keys_in(before, was) != keys_in(after, &object);
}

// The object that a step is about: the active one if the step changed it, else another that it changed, or
// that it took out; null: none.
const ObjectItem* object_of_step(const History& history, std::size_t entry) {
  if (entry == 0) return nullptr;
  const History::Entry &before = history.entries()[entry - 1], &after = history.entries()[entry];
  const ObjectItem* active = after.document.active_object();
  if (active && is_changed(before, after, *active)) return active;
  for (const ObjectItem& object : after.document.objects)
    if (is_changed(before, after, object)) return &object;
  for (const ObjectItem& object : before.document.objects)
    if (!after.document.find(object.id)) return &object;
  return nullptr;
}

// Shares those of the entry before that are the same, place by place.
std::vector<std::shared_ptr<const ObjectKeys>> keys_of(const Document& document,
                                                       const History::Entry& before) {
  std::vector<std::shared_ptr<const ObjectKeys>> keys;
  for (const ObjectItem& object : document.objects) {
    const CutRequest request = cut_request(document, object);
    ObjectKeys made{cut_key(document, object), key_of_first_stroke(request), key_of_last_stroke(request)};
    const std::size_t place = keys.size();
    const bool known = place < before.keys.size() && *before.keys[place] == made;
    keys.push_back(known ? before.keys[place] : std::make_shared<const ObjectKeys>(std::move(made)));
  }
  return keys;
}

}  // namespace

void History::reset(Document document, std::string title) {
  entries_.clear();
  auto keys = keys_of(document, {});
  entries_.push_back({std::move(title), {}, std::move(document), std::move(keys), 0});
  cursor_ = 0;
  left_.reset();
  serial_ = steps_serial_ = next_serial();
  merging_ = false;
}

void History::reset(const SavedSteps& saved) {
  assert(saved.cursor < saved.steps.size());
  entries_.clear();
  const Entry none;
  SharedArrays arrays;  // the state at the cursor was read from elsewhere in the file
  for (const SavedSteps::Step& step : saved.steps) {
    Document document = step.document;
    visit_arrays(document, [&](Flags& flags) { arrays.share(&flags); });
    auto keys = keys_of(document, entries_.empty() ? none : entries_.back());
    const bool other_files = step.other_files && !entries_.empty();  // the first one leads back to nothing
    entries_.push_back({step.title, {}, std::move(document), std::move(keys), other_files ? kNotKept : 0});
  }
  cursor_ = saved.cursor;
  left_.reset();
  merging_ = false;
  serial_ = steps_serial_ = next_serial();
  const std::vector<ObjectItem> known = now().objects;
  for (const ObjectItem& object : known)
    if (object.cut && !object.cut_kept && !object.cut_key.empty())
      set_cut(object.id, object.cut_key, object.cut);
}

const ObjectKeys& History::keys(const ObjectItem& object) const {
  const std::vector<ObjectItem>& objects = now().objects;
  const auto found = std::ranges::find(objects, object.id, &ObjectItem::id);
  assert(found != objects.end());
  return *entries_[cursor_].keys[static_cast<std::size_t>(found - objects.begin())];
}

bool History::merges(std::string_view merge_key) const {
  return merging_ && !merge_key.empty() && entries_[cursor_].merge_key == merge_key && cursor_ > 0;
}

bool History::push(std::string title, Document after, std::string merge_key) {
  const Entry& before = entries_[cursor_];
  Entry entry{std::move(title), std::move(merge_key), std::move(after), {}, 0};
  entry.keys = keys_of(entry.document, before);
  // The same keys are the same objects, see keys_of().
  if (entry.keys == before.keys && same_but_strokes(entry.document, before.document)) return false;
  entries_.resize(cursor_ + 1);
  left_.reset();
  if (merges(entry.merge_key)) {
    entries_.back() = std::move(entry);
  } else {
    entries_.push_back(std::move(entry));
    ++cursor_;
  }
  merging_ = true;
  serial_ = steps_serial_ = next_serial();
  constexpr std::size_t kCheckEvery = 8;  // counting walks the whole history
  if (entries_.size() % kCheckEvery == 0) forget_oldest();
  return true;
}

void History::push_other_files(std::string title, std::uint64_t number) {
  forget_redo();
  Entry entry = entries_[cursor_];
  entry.title = std::move(title);
  entry.merge_key.clear();
  entry.other_files = number;
  entries_.push_back(std::move(entry));
  ++cursor_;
  merging_ = false;
  serial_ = steps_serial_ = next_serial();
}

void History::forget_redo() {
  if (can_redo()) steps_serial_ = next_serial();
  left_.reset();
  entries_.resize(cursor_ + 1);
}

void History::forget_oldest() {
  while (cursor_ > 1 && distinct_bytes(entries_) > kMostBytes) {
    entries_.erase(entries_.begin());
    --cursor_;
  }
}

void History::go_to(std::size_t entry) {
  assert(entry < entries_.size());
  left_ = std::exchange(cursor_, entry);
  merging_ = false;
  serial_ = next_serial();
}

void History::undo() {
  assert(can_undo());
  go_to(cursor_ - 1);
}

void History::redo() {
  assert(can_redo());
  go_to(cursor_ + 1);
}

void History::jump(std::size_t entry) {
  go_to(entry);
}

void History::set_cut(ObjectId object, const std::string& cut_key, const Flags& cut) {
  for (Entry& entry : entries_)
    for (std::size_t i = 0; i < entry.keys.size(); ++i) {
      ObjectItem& item = entry.document.objects[i];
      if (item.id != object || entry.keys[i]->cut != cut_key) continue;
      item.cut = cut;
      item.cut_key = cut_key;
      item.cut_kept = false;
    }
  serial_ = next_serial();
}

void History::carry(const std::function<Document(const Document&)>& carried) {
  const Entry none;
  const Entry* before = &none;
  for (Entry& entry : entries_) {
    entry.document = carried(entry.document);
    entry.keys = keys_of(entry.document, *before);
    before = &entry;
  }
  merging_ = false;
  serial_ = next_serial();
}

void History::change_all(const std::function<void(Document*)>& change) {
  const ObjectId active = now().active;
  for (Entry& entry : entries_) change(&entry.document);
  merging_ = merging_ && now().active == active;
  serial_ = next_serial();
}

std::string row_title(const History& history, std::size_t entry) {
  const ObjectItem* object = object_of_step(history, entry);
  if (!object) return history.entries()[entry].title;
  const ObjectItem* before = history.entries()[entry - 1].document.find(object->id);
  const std::size_t strokes = stroke_count(*object), strokes_before = before ? stroke_count(*before) : 0;
  const bool several = std::ranges::any_of(
      history.entries(), [](const History::Entry& e) { return e.document.objects.size() > 1; });
  const std::string name = several ? object->name : "",
                    stroke =
                        strokes > 1 && strokes > strokes_before ? "stroke " + std::to_string(strokes) : "",
                    between = name.empty() || stroke.empty() ? "" : ", ";
  const std::string& title = history.entries()[entry].title;
  return name.empty() && stroke.empty() ? title : title + "  (" + name + between + stroke + ")";
}

const Document* before_last_stroke(const History& history, ObjectId object) {
  struct State {
    const ObjectItem* item = nullptr;  // null: the object was not there
    const ObjectKeys* keys = nullptr;
    const Document* document = nullptr;
  };
  const auto state = [&](std::size_t entry) -> State {
    const History::Entry& e = history.entries()[entry];
    const ObjectItem* item = e.document.find(object);
    if (!item) return {};
    return {item, e.keys[static_cast<std::size_t>(item - e.document.objects.data())].get(), &e.document};
  };
  const State now = state(history.cursor());
  std::size_t at = history.cursor();
  const auto go_back_while_same = [&](std::string ObjectKeys::*key) {
    const auto is_same = [&](const State& s) {
      return s.item && s.keys->*key == now.keys->*key && s.item->hand == now.item->hand &&
             s.item->of_others == now.item->of_others && s.document->deleted == now.document->deleted &&
             s.item->smoothness == now.item->smoothness && s.document->preset == now.document->preset &&
             s.item->left_out.size() == now.item->left_out.size();
    };
    while (at > 0 && is_same(state(at - 1))) --at;
  };
  const auto last_step = [](const ObjectItem& item) { return last_stroke(item.views)->size_step; };
  if (!now.item || now.keys->last_click.empty()) return nullptr;
  go_back_while_same(&ObjectKeys::cut);  // to the first state with this cut
  if (at == 0) return nullptr;
  const std::size_t made = at;
  const State before = state(made - 1);
  const std::size_t strokes = stroke_count(*now.item);
  const bool is_stroke = !before.item || stroke_count(*before.item) < strokes;
  if (!is_stroke &&
      (before.keys->last_click != now.keys->last_click || last_step(*before.item) == last_step(*now.item)))
    return nullptr;
  // To the first state with this stroke: between lie steps of its size.
  go_back_while_same(&ObjectKeys::last_click);
  // Opened work holds steps without their cuts: their labels are not known.
  const auto has_labels = [](const State& s) {
    return s.item && (s.item->cut || (s.item->hand && stroke_count(*s.item) == 0));
  };
  const State first = at > 0 ? state(at - 1) : State();
  if (has_labels(first) && stroke_count(*first.item) < strokes) return first.document;
  const State own_size = state(at);
  return at < made && has_labels(own_size) ? own_size.document : nullptr;
}

void leave_in_history(History* history, const ObjectItem before, const ObjectItem& after,
                      std::span<const ObjectId> came) {
  const Document now = history->now();
  const auto has_the_same = [&](const Document& state, ObjectId id) {
    const ObjectItem *here = now.find(id), *there = state.find(id);
    return here && there && there->cut == here->cut && there->hand == here->hand &&
           there->of_others == here->of_others && there->within == here->within;
  };
  history->change_all([&](Document* state) {
    ObjectItem* same = state->find(before.id);
    if (!same || same->leaves_also != before.leaves_also || same->of_others != before.of_others ||
        !std::ranges::all_of(came, [&](ObjectId id) { return has_the_same(*state, id); }))
      return;
    const bool same_hand = same->hand == before.hand;
    set_left_earlier(same, after.of_others);
    if (same_hand) same->hand = after.hand;  // one array for all
    same->leaves_also = after.leaves_also;
  });
}

}  // namespace splatcut
