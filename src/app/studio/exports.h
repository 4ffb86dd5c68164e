// Files that the window writes for other programs: scenes, pictures of the view, turntables. The worker
// writes them from the document as it is at the time of the command.
#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "app/document/command.h"
#include "app/workspace/viewport.h"
#include "app/workspace/workspace.h"

namespace splatcut {

class Exports {
 public:
  Exports(Workspace& workspace, const Viewport& viewport) : ws_(workspace), viewport_(viewport) {}

  void perform(const Export& c);
  void perform(const SaveSnapshot& c);
  void perform(const SaveTurntable& c);

  void reset() {  // another scene was opened
    last_.clear();
    exported_.clear();
  }

  // Path of the scene, folder of scenes, or turntable that was written last of the scene that is open; empty:
  // none was.
  const std::filesystem::path& last() const { return last_; }
  // Folder in which the last of all was written, also before the program began; empty: none was, or
  // it was the scene's own.
  const std::filesystem::path& folder() const { return folder_; }
  // What is being written, or is the first that waits to be, be it a scene, a picture or a turntable; empty:
  // nothing is.
  std::string doing() const;
  // True: every object is in a file as it is now, and the objects are all that was made.
  bool have_all() const;
  void begin_in(std::filesystem::path folder) { folder_ = std::move(folder); }

 private:
  struct Exported {  // how an object was written last
    std::filesystem::path path;
    Flags labels;
  };

  // What is said at once of an export of these objects.
  std::string announced(const ExportRequest& request, const std::map<ObjectId, Flags>& objects) const;
  void written(const std::filesystem::path& path, const OpenedScene& of);
  // Hands work to the worker that doing() calls `text` until it ends or is dropped.
  void submit(TaskThread::Order order, std::string text, TaskThread::Work work);

  Workspace& ws_;
  const Viewport& viewport_;
  std::filesystem::path last_, folder_;
  // Texts for doing() in the order of the tasks; each task holds its own, which goes with it.
  std::deque<std::weak_ptr<const std::string>> doing_;
  std::map<ObjectId, Exported> exported_;
};

}  // namespace splatcut
