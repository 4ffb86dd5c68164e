// Messages for the message strip, and requests to the interface.
#pragma once

#include <string>

namespace splatcut {

// A message in the message strip.
struct Message {
  enum class Kind { kInfo, kDone, kRefused, kError };
  Kind kind = Kind::kInfo;
  std::string text;
  double time_s = 0;  // time by Workspace::clock_s
};

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
