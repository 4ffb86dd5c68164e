// Messages for the message strip, and requests to the interface.
#pragma once

#include <deque>
#include <functional>
#include <string>

namespace splatcut {

// A message in the message strip.
struct Message {
  enum class Kind { kInfo, kDone, kRefused, kError };
  Kind kind = Kind::kInfo;
  std::string text;
  double time_s = 0;  // time by Workspace::clock_s
  // True: it was waited for, and is shown until it could be read, whatever comes behind or before it.
  bool stays = false;
};

// The message that the strip shows: the newest, but not before one that warns could be read. Null: none.
const Message* shown_message(const std::deque<Message>& messages, double now_s);
// Adds what is known of an answer only later to the newest message: what is of the same object behind it,
// else as a line of its own. Returns false, and adds nothing, where that message is not shown.
bool add_to_shown(Message::Kind kind, const std::string& text, double now_s, std::deque<Message>* messages);
// A text that does not fit loses sentences behind its first, which says what was done: as few as do, so that
// the last, which says what is to be noted, stays if it can. The first stays also where it does not fit.
std::string shortened(const std::string& text, const std::function<bool(const std::string&)>& fits);

// Requests that only the interface can fulfil.
enum class UiRequest {
  kOpenDialog,
  kAddDialog,
  kSaveDialog,
  kExportDialog,
  kHelp,
  kSettings,
  kTheme,
  kHistory,
  kQuit,
  kSnapshotDialog,
  kExportFailed,  // the export dialog shall come back as it was
  kFillKept       // the file that was added stands where it belongs
};

}  // namespace splatcut
