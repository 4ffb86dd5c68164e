// Workspace that the parts of the window's program share: the document with its history, the opened scene,
// the view settings, messages, and the threads that do the work. Only the main thread uses it.
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
#include "app/document/seen_object.h"
#include "app/tools/pointer_tools.h"
#include "app/workspace/messages.h"
#include "app/workspace/task_thread.h"
#include "scene/cloud/coarse_cloud.h"

namespace splatcut {

struct StudioOptions {
  std::function<void()> wake;          // function that any thread calls when update() has something to do
  bool inline_tasks = false;           // true: tasks run inside apply(), for tests
  std::filesystem::path state_folder;  // folder for autosaves; empty: none are written
  PreparedCache cache;                 // cache of what was prepared for clicks
  bool works_ahead = true;             // false: nothing is made before it is asked for, for tests
  // Gaussians of scenes kept to undo changes of files; the last three scenes are kept however large they are.
  std::size_t most_kept_gaussians = 6'000'000;
};

struct Workspace {
  StudioOptions options;
  TaskThread& tasks;   // worker that loads, prepares, cuts and writes files, which takes seconds
  TaskThread& writes;  // worker for autosaves, which wait for no cut
  TaskThread& quick;   // worker for selections and styles, which take a few passes over the Gaussians

  History history{};
  ViewState view{};
  std::uint64_t view_serial = 1;  // number that changes with `view` and with previews of a cut
  PointerTools tools{};
  Modifiers held_modifiers{};
  std::shared_ptr<const OpenedScene> scene{};   // opened scene; null: none
  std::shared_ptr<Session> session{};           // session on the scene, used on `tasks`; null without a scene
  std::shared_ptr<SceneGraph> graph{};          // graph of the scene, built when an edit first asks for it
  std::shared_ptr<CleanObjects> clean{};        // objects of the scene with clean edges
  std::shared_ptr<const SeenObject> seen{};     // what views showed of an object; null: not asked so far
  std::shared_ptr<const CoarseCloud> coarse{};  // cloud for pictures of a large scene in motion; null: none
  mutable LabelCache labels{};
  std::deque<Message> messages{};  // last hundred messages, the newest last
  std::vector<UiRequest> ui_requests{};
  double clock_s = 0;  // sum of the seconds that update() was given

  const Document& document() const { return history.now(); }
  std::size_t gaussians() const { return scene ? scene->cloud->size() : 0; }
  std::size_t gaussians_of(ObjectId object) const;  // number of its Gaussians; 0: there is no such object
  EditContext context() const { return {*scene->cloud, graph.get(), {}, history.left(), &labels}; }
  void require_scene() const;  // throws Error without one
  void say(Message::Kind kind, std::string text);
  // What comes by itself, not as the answer to what was done: beside the message that is shown.
  void say_also(Message::Kind kind, const std::string& text);
};

}  // namespace splatcut
