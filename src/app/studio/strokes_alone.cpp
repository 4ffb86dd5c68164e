// Alt of the stroke tools, Ctrl and Alt of the box: what a stroke alone would cut out, combined with the
// object.
#include "app/studio/clicks.h"
#include "core/error.h"

namespace splatcut {

// Whether the active object has all that a view shows: a box there could add nothing.
bool Clicks::has_all(const Flags& seen) const {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || !seen || cuts_.comes(*object)) return false;
  const Flags labels = ws_.labels.labels(ws_.document(), *object, ws_.gaussians());
  for (std::size_t g = 0; g < labels->size(); ++g)
    if ((*seen)[g] && !(*labels)[g]) return false;
  return true;
}

void Clicks::combine_with(const CameraStroke& stroke, SetOperation operation, const std::string& title) {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || ws_.gaussians_of(object->id) == 0)
    throw Error("", "There is no object yet", "Click one first");
  const std::uint64_t edit = edits_.begin();
  ws_.tasks.submit({TaskKind::kSelect, [this, edit] { edits_.end(edit); }},
                   [this, edit, stroke, operation, title, session = ws_.session,
                    settings = cut_settings(ws_.document(), *object)](const Job& job) {
                     const Session::Preview preview = session->preview({}, stroke, settings, {job.stop, {}});
                     if (job.cancelled()) return;
                     ws_.tasks.post([this, edit, operation, title, settings, meant = preview.after] {
                       edits_.end(edit, [&] {
                         if (!meant.empty()) return edits_.select_later(meant, operation, title);
                         const bool by_parts = settings.first_mask_from == FirstMaskFrom::kParts;
                         ws_.say(Message::Kind::kRefused,
                                 by_parts
                                     ? "There is nothing in that place"
                                     : "With this method there are no parts that a click could take. Use "
                                       "a region, or choose another method.");
                       });
                     });
                   });
}

void Clicks::perform(const IntersectStroke& c) {
  ws_.require_scene();
  if (c.stroke.points_px.empty()) throw Error("", "The stroke has no points");
  if (!hits_anything({c.camera, c.stroke, c.seen}))
    throw Error("", "There is nothing in that place", "Click on something that can be seen");
  const CameraStroke alone{c.camera, c.stroke, c.seen};
  edits_.once_cut(SetOperation::kIntersect, "Intersect (click)",
                  [this, alone] { combine_with(alone, SetOperation::kIntersect, "Intersect (click)"); });
}

void Clicks::perform(const AddBox& c) {
  ws_.require_scene();
  if (c.operation != SetOperation::kAdd) {
    const std::string title = std::string(title_of(c.operation)) + " (box)";
    const CameraStroke alone{c.camera, stroke_of(c, SeedLabel::kObject), c.seen};
    return edits_.once_cut(c.operation, title, [this, alone, operation = c.operation, title] {
      combine_with(alone, operation, title);
    });
  }
  AddBox made = c;
  if (asks_what_is_hit(ws_.document(), SeedLabel::kObject, ws_.context()))
    made.hits = viewport_.hit_by({c.camera, stroke_of(c, SeedLabel::kObject), c.seen});
  Document after = ws_.document();
  const std::string message = edit(&after, made, ws_.context());
  if (has_all(c.seen))
    throw Error("", "All that is shown belongs to " + ws_.document().active_object()->name + " already",
                "The right button, or Ctrl, removes what a box holds; Alt keeps it alone");
  turns_about_ = after.active;
  edits_.push(c.title(), std::move(after), {}, message);
}

}  // namespace splatcut
