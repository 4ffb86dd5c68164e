// What strokes alone would cut out, taken from the object or kept of it: Alt of the stroke tools, Ctrl and
// Alt of the box.
#include <fmt/format.h>

#include "app/studio/document_edits.h"
#include "app/studio/studio.h"
#include "core/error.h"

namespace splatcut {

void Studio::combine_with(const StrokedView& strokes, SetOperation operation, const std::string& title) {
  const std::string doing = operation == SetOperation::kRemove ? "remove" : "intersect";
  const ObjectItem* object = document().active_object();
  if (!object || gaussians_of(object->id) == 0)
    throw Error(doing, "there is no object yet", "Click one first");
  if (!session_) throw Error(doing, "the scene is still being prepared", "Try again in a moment");
  tasks_.submit(TaskKind::kSelect, [this, strokes, operation, title, doing, id = object->id,
                                    session = session_, scene = scene_,
                                    settings = cut_settings(document(), *object)](const Job& job) {
    CutRequest before;
    before.strokes = {{strokes.camera, {strokes.strokes.begin(), strokes.strokes.end() - 1}, strokes.seen}};
    const Session::Preview preview = session->preview(
        before, {strokes.camera, strokes.strokes.back(), strokes.seen}, settings, {job.stop, {}});
    if (job.cancelled()) return;
    tasks_.post([this, id, scene, operation, title, doing, meant = preview.after] {
      if (scene != scene_ || document().active != id) return;
      if (meant.empty())
        say(Message::Kind::kRefused, doing +
                                         ": with this quality there are no parts that a click could take. "
                                         "Use a region, or choose another quality.");
      else
        select_or_refuse(meant, operation, title);
    });
  });
  if (options_.inline_tasks) tasks_.deliver();
}

// Keeps those Gaussians of the object that the stroke alone would select.
void Studio::perform(const IntersectStroke& c) {
  require_scene();
  if (c.stroke.points_px.empty()) throw Error("stroke", "it has no points");
  if (!hits_anything({c.camera, c.stroke, c.seen}))
    throw Error("click", "there is nothing in that place", "Click on something that can be seen");
  combine_with({c.camera, {c.stroke}, c.seen}, SetOperation::kIntersect, "Intersect (click)");
}

void Studio::perform(const AddBox& c) {
  require_scene();
  if (c.operation != SetOperation::kAdd) {
    const bool removes = c.operation == SetOperation::kRemove;
    return combine_with({c.camera, strokes_of(c, true), c.seen}, c.operation,
                        removes ? "Remove (box)" : "Intersect (box)");
  }
  Document after = history_.now();
  const std::string message = edit(&after, c, context());
  push("Box", std::move(after), {}, message);
}

}  // namespace splatcut
