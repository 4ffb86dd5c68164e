// Undo and redo by keeping every state of the document; large arrays are shared between states, so a step
// costs what it changed. The state at the cursor is the document; nothing else writes it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/document/document.h"

namespace splatcut {

// What the labels of an object, and the meanings of its first click, depend on: bytes to compare.
struct ObjectKeys {
  std::string cut;          // cut_key()
  std::string first_click;  // key_of_first_stroke()
  bool operator==(const ObjectKeys&) const = default;
};

// Steps of a history as files hold them.
struct SavedSteps {
  struct Step {
    std::string title;
    Document document;
  };
  std::vector<Step> steps;
  std::size_t cursor = 0;
};

class History {
 public:
  struct Entry {
    std::string title;      // what was done, for the list
    std::string merge_key;  // consecutive steps with the same non-empty key become one (a slider as it moves)
    Document document;      // after it was done
    std::vector<std::shared_ptr<const ObjectKeys>> keys;  // of its objects, made once
    std::uint64_t other_files =
        0;  // not 0: a step to other files of the scene, which whoever made it takes back
  };

  History() { reset({}, "Open"); }
  void reset(Document document, std::string title);
  // At least one step. Labels known at the cursor reach the others.
  void reset(const SavedSteps& saved);

  const Document& now() const { return entries_[cursor_].document; }
  // Changes whenever now() does; never 0, and that of no other document of the program.
  std::uint64_t serial() const { return serial_; }
  const ObjectKeys& keys(const ObjectItem& object) const;  // of an object of now()
  const std::vector<Entry>& entries() const { return entries_; }
  std::size_t cursor() const { return cursor_; }
  bool can_undo() const { return cursor_ > 0; }
  bool can_redo() const { return cursor_ + 1 < entries_.size(); }

  // False where the document is as before: nothing to undo.
  bool push(std::string title, Document after, std::string merge_key = {});
  bool merges(std::string_view merge_key) const;  // a push with it would replace the step at the cursor
  // A step that changes nothing of the document. What could be redone is forgotten.
  void push_other_files(std::string title, std::uint64_t number);
  void forget_redo();
  void undo();
  void redo();
  void jump(std::size_t entry);

  // The result of a cut reaches every state that has exactly its inputs: undo and redo find it, too.
  void set_cut(ObjectId object, const std::string& cut_key, const Flags& cut);

  // Every state becomes what `carried` makes of it: the scene has other Gaussians.
  void carry(const std::function<Document(const Document&)>& carried);
  // In every state, what is no work and no object depends on.
  void change_all(const std::function<void(Document*)>& change);

 private:
  void forget_oldest();

  std::vector<Entry> entries_;
  std::size_t cursor_ = 0;
  std::uint64_t serial_ = 0;
  bool merging_ = false;
};

}  // namespace splatcut
