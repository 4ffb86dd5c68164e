// What the program says of itself in the message strip, newest last.
#pragma once

#include <string>

namespace splatcut {

struct Message {
  enum class Kind { kInfo, kDone, kRefused, kError };
  Kind kind = Kind::kInfo;
  std::string text;
  double time_s = 0;  // Workspace's clock
};

// Requests that only the interface can fulfil.
enum class UiRequest {
  kOpenDialog,
  kAddDialog,
  kSaveDialog,
  kExportDialog,
  kHelp,
  kTheme,
  kHistory,
  kQuit,
  kSnapshotDialog,
  kExportFailed  // the dialog comes back as it was
};

}  // namespace splatcut
