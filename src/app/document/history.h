// Undo and redo. The history keeps every state of the document; states share large arrays, so a step costs
// the memory of what it changed. The state at the cursor is the document, and only the history writes it. The
// oldest states go once their arrays take more than 1 GiB.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/document/document.h"

namespace splatcut {

// Keys of an object, as bytes to compare: everything that its labels, the meanings of its first click and the
// sizes of its last depend on.
struct ObjectKeys {
  std::string cut;          // cut_key()
  std::string first_click;  // key_of_first_stroke()
  std::string last_click;   // key_of_last_stroke()
  bool operator==(const ObjectKeys&) const = default;
};

// Steps of a history, as work files hold them. cursor: index into steps.
struct SavedSteps {
  struct Step {
    std::string title;
    Document document;
    bool other_files = false;  // true: the step changed the files of the scene
  };
  std::vector<Step> steps;
  std::size_t cursor = 0;
  std::vector<std::size_t> compared{};  // steps before each object's last stroke: before_last_stroke()
};

class History {
 public:
  struct Entry {
    std::string title;      // name of the step, for the list
    std::string merge_key;  // consecutive steps with the same non-empty key become one (a slider as it moves)
    Document document;      // state after the step
    std::vector<std::shared_ptr<const ObjectKeys>> keys;  // keys of the document's objects, made once
    // Number of a step to other files of the scene, which SceneFiles takes back; 0: the step is no such step;
    // kNotKept: nothing takes it back, as it comes from a work file.
    std::uint64_t other_files = 0;
  };
  static constexpr std::uint64_t kNotKept = std::numeric_limits<std::uint64_t>::max();

  History() { reset({}, "Open"); }
  void reset(Document document, std::string title);
  // saved: at least one step. Labels of the state at the cursor reach other states that have the same inputs.
  void reset(const SavedSteps& saved);

  const Document& now() const { return entries_[cursor_].document; }
  // Number that changes whenever now() does. It is never 0, and no other state in the program has it.
  std::uint64_t serial() const { return serial_; }
  // Number that changes whenever steps are added or forgotten at the end of the list, and that no other list
  // in the program has.
  std::uint64_t steps_serial() const { return steps_serial_; }
  const ObjectKeys& keys(const ObjectItem& object) const;  // keys of an object of now()
  const std::vector<Entry>& entries() const { return entries_; }
  std::size_t cursor() const { return cursor_; }
  bool can_undo() const { return cursor_ > 0; }
  bool can_redo() const { return cursor_ + 1 < entries_.size(); }

  // Makes `after` the document and forgets what could be redone. Returns false and makes no step if `after`
  // equals the document.
  bool push(std::string title, Document after, std::string merge_key = {});
  // True if a push with this key would replace the step at the cursor.
  bool merges(std::string_view merge_key) const;
  // Adds a step that leaves the document as it is, see Entry::other_files. Forgets what could be redone.
  void push_other_files(std::string title, std::uint64_t number);
  void forget_redo();
  void undo();
  void redo();
  void jump(std::size_t entry);
  // The state that undo(), redo() or jump() led away from last; none: what is there now was done.
  const Document* left() const { return left_ ? &entries_[*left_].document : nullptr; }

  // Stores the labels of a cut in every state that has exactly its inputs, so that undo and redo find them.
  void set_cut(ObjectId object, const std::string& cut_key, const Flags& cut);

  // Replaces every state by what `carried` makes of it, as the scene has other Gaussians now.
  void carry(const std::function<Document(const Document&)>& carried);
  // Changes every state. `change` must not touch anything that cuts depend on.
  void change_all(const std::function<void(Document*)>& change);

 private:
  void forget_oldest();
  void go_to(std::size_t entry);

  std::vector<Entry> entries_;
  std::size_t cursor_ = 0;
  std::uint64_t serial_ = 0, steps_serial_ = 0;
  bool merging_ = false;
  std::optional<std::size_t> left_;  // index of left()
};

// A step's title for the list, where several are called alike: with its object, where there are several, and
// the number of the stroke that it added to others. entry: index into entries().
std::string row_title(const History& history, std::size_t entry);

// The state before the last stroke of an object of now(), whatever size that stroke has now; where nothing of
// the object was before, as before its first, the state in which the stroke had its own size. Null: there is
// none, or the object was changed since otherwise, by hand, by settings or by another meaning.
const Document* before_last_stroke(const History& history, ObjectId object);

// Makes `before`, an object of now(), what left_what_came() made of it, in every state in which it waits for
// the same others and these have what they have now. In others it is done when they become the present one.
void leave_in_history(History* history, ObjectItem before, const ObjectItem& after,
                      std::span<const ObjectId> came);

}  // namespace splatcut
