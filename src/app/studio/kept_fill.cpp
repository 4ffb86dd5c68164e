// What fills the hole of an object is kept: as a file that is added to the scene, and as an object.
#include <algorithm>
#include <utility>

#include "app/console/kept_inputs.h"
#include "app/studio/scene_files.h"
#include "core/error.h"

namespace splatcut {

namespace {

// The document in which the file is an object, where there is room for one, and what it replaces is deleted.
Document with_fill(Document document, const OpenedScene& scene, std::uint32_t file, const Flags& replaced) {
  std::vector<std::uint8_t> deleted = *replaced;
  for (std::size_t g = 0; document.deleted && g < deleted.size(); ++g) deleted[g] |= (*document.deleted)[g];
  document.deleted = make_flags(std::move(deleted));
  if (document.objects.size() >= kMostObjects) return document;
  const ObjectId active = document.active;
  ObjectItem& fill = add_object(&document, "Fill");
  fill.tinted = false;  // no tint and no outline
  set_labels(&document, &fill, gaussians_of(scene, file));
  document.active = active;
  return document;
}

}  // namespace

void SceneFiles::perform(const KeepFill& c) {
  ws_.require_scene();
  const std::shared_ptr<const SceneWithout> without = calls_.without();
  if (!without || without->patch.changes.given_back.empty())
    throw Error("", "No hole is filled", "Fill one first: Ctrl+H");
  refuse_written_inputs(c.path, ws_.scene->scene->files);
  ws_.tasks.submit(TaskKind::kExport, [this, path = c.path, without, scene = ws_.scene,
                                       up = ws_.document().up_world](const Job& job) {
    save_scene(path, with_cloud(*scene->scene, without->patch.changes.given_back), {}, SceneFormat::kPly,
               {.up = up});
    if (job.cancelled()) return;
    ws_.tasks.post([this, path, without, scene] {
      if (scene != ws_.scene || calls_.without() != without || (filling_ && changing()))
        return ws_.say(Message::Kind::kRefused,
                       path.string() + " is written, but not added: what it fills has changed meanwhile");
      std::vector<std::uint8_t> replaced(ws_.gaussians(), 0);
      for (const std::uint32_t g : without->patch.changes.ghosts) replaced[g] = 1;
      filling_ = {next_file_id_, make_flags(std::move(replaced))};
      std::vector<SceneSource> files = wanted_files();
      files.push_back({.id = next_file_id_++, .path = path, .fills = ws_.document().active});
      change_files(std::move(files), "Keeping what fills the hole",
                   {"Fill kept; it is an object, and a file of the scene", {}});
    });
  });
}

bool SceneFiles::fills_hole_of(ObjectId object) const {
  // Without what it replaces, keeping it was undone; the object's number may be another's by now.
  return object != 0 && ws_.scene && ws_.document().deleted &&
         std::ranges::count(ws_.scene->files, object, &SceneSource::fills) > 0;
}

// The document is that of the scene with the file.
void SceneFiles::fill_came(const OpenedScene& scene, const Flags& replaced) {
  const auto fill = std::exchange(filling_, {});
  if (!fill || !replaced) return;
  ws_.history.push("Fill as an object", with_fill(ws_.document(), scene, fill->file, replaced));
  ws_.view.fill_hole = false;  // it is filled
  ws_.ui_requests.push_back(UiRequest::kFillKept);
}

}  // namespace splatcut
