// What the parts of the program share: the document with its history, the opened scene, how it is looked at,
// messages, and the threads that do the work. Main thread.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/document/clean_objects.h"
#include "app/document/document_edits.h"
#include "app/document/history.h"
#include "app/document/label_cache.h"
#include "app/document/opened_scene.h"
#include "app/studio/messages.h"
#include "app/studio/task_thread.h"
#include "app/tools/pointer_tools.h"
#include "scene/cloud/coarse_cloud.h"

namespace splatcut {

struct StudioOptions {
  std::function<void()> wake;          // called from any thread when update() has something to do
  bool inline_tasks = false;           // for tests: tasks run inside apply()
  std::filesystem::path state_folder;  // for the autosave; empty: none is written
  PreparedCache cache;                 // of scenes once prepared
};

struct Workspace {
  StudioOptions options;
  TaskThread& tasks;  // load, prepare, cut, write files: seconds
  TaskThread& quick;  // selections and styles: a few passes over the Gaussians

  History history{};
  ViewState view{};
  std::uint64_t view_serial = 1;  // changes with `view` and with previews of a cut
  PointerTools tools{};
  Modifiers held_modifiers{};
  std::shared_ptr<const OpenedScene> scene{};   // null: none
  std::shared_ptr<Session> session{};           // of the scene, for `tasks`; null as long as it is
  std::shared_ptr<SceneGraph> graph{};          // of the scene, made at the first edit that asks for it
  std::shared_ptr<CleanObjects> clean{};        // of the scene
  std::shared_ptr<const CoarseCloud> coarse{};  // of large scenes, for pictures while the view moves
  mutable LabelCache labels{};
  std::deque<Message> messages{};  // the last hundred
  std::vector<UiRequest> ui_requests{};
  double clock_s = 0;

  const Document& document() const { return history.now(); }
  std::size_t gaussians() const { return scene ? scene->cloud->size() : 0; }
  std::size_t gaussians_of(ObjectId object) const;  // 0 where there is no such object
  EditContext context() const { return {*scene->cloud, graph.get()}; }
  void require_scene() const;  // throws Error without one
  void say(Message::Kind kind, std::string text);
};

}  // namespace splatcut
