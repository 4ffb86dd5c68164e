#include "app/studio/clicks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "app/document/selection.h"
#include "app/picture/cut_sentences.h"
#include "core/error.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

namespace {

bool any_mark(const ObjectItem& object) {
  return std::ranges::any_of(object.views, marks_object);
}

}  // namespace

// Whether anything can be seen within reach of one of the stroke's points: as far as the selection reaches.
bool Clicks::hits_anything(const AddStroke& c) const {
  constexpr float kReachShare = 4.0f / 320;  // of the picture's width
  constexpr float kLeastAlpha = 0.25f;       // less counts as invisible
  const float reach = std::max(1.0f, kReachShare * static_cast<float>(c.camera.width_px));
  glm::vec2 low = c.stroke.points_px.front(), high = low;
  for (const glm::vec2& p : c.stroke.points_px) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::vec2 most(c.camera.width_px, c.camera.height_px);
  const glm::ivec2 from = glm::clamp(glm::floor(low - reach), glm::vec2(0), most),
                   to = glm::clamp(glm::ceil(high + reach) + 1.0f, glm::vec2(0), most);
  const PixelRect around{from.x, from.y, to.x, to.y};
  if (around.empty()) return false;
  const std::shared_ptr<const Frame> frame =
      viewport_.panes() == 1 ? viewport_.full_picture_of(c.camera) : nullptr;
  Image<float> drawn;
  if (!frame) drawn = viewport_.drawn(c.camera, around, c.seen).alpha;
  const auto alpha = [&](int x, int y) {
    return frame ? frame->alpha.at(x, y) : drawn.at(x - from.x, y - from.y);
  };
  for (int y = from.y; y < to.y; ++y)
    for (int x = from.x; x < to.x; ++x) {
      if (alpha(x, y) < kLeastAlpha) continue;
      const auto within = [&](const glm::vec2& p) { return glm::distance(glm::vec2(x, y), p) <= reach; };
      if (std::ranges::any_of(c.stroke.points_px, within)) return true;
    }
  return false;
}

// A message if the click changes nothing, as the screen shows it so already; else empty.
std::string Clicks::already_so(const AddStroke& c) const {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || !any_mark(*object) || cuts_.comes(*object) || !c.stroke.is_click() ||
      viewport_.panes() == 2 || !viewport_.active_labels() || !same_camera(c.camera, viewport_.pane_camera()))
    return {};
  const auto hit = viewport_.pick(c.stroke.points_px.front());
  if (!hit) return {};
  const bool is_part = (*viewport_.active_labels())[static_cast<std::size_t>(hit->gaussian)] != 0;
  if (is_part != (c.stroke.label == SeedLabel::kObject)) return {};
  return is_part ? fmt::format("That is part of {} already, and stays so", object->name)
                 : fmt::format("That is not part of {} as it is", object->name);
}

void Clicks::perform(const AddStroke& c) {
  ws_.require_scene();
  if (!c.stroke.points_px.empty() && !hits_anything(c))
    throw Error("", "There is nothing in that place", "Click on something that can be seen");
  const std::string held = already_so(c);
  AddStroke made = c;
  if (asks_what_is_hit(ws_.document(), c.stroke.label, ws_.context()))
    made.hits = viewport_.hit_by({c.camera, c.stroke, c.seen});
  Document after = ws_.document();
  std::string message = edit(&after, made, ws_.context());
  const ObjectItem* object = ws_.document().active_object();
  if (const std::size_t waiting =
          object && cuts_.comes(*object) ? waiting_strokes(ws_.history, object->id) : 0)
    message += fmt::format(". {} strokes wait and are computed together", waiting + 1);
  const bool adds = c.stroke.label == SeedLabel::kObject && same_camera(c.camera, viewport_.pane_camera());
  const auto on = adds ? viewport_.pick(c.stroke.points_px.front()) : std::nullopt;
  // The view turns around what was clicked; around the object as long as that is alone.
  if (on && ws_.view.display == DisplayMode::kWhole && c.stroke.is_click() && viewport_.panes() == 1)
    viewport_.camera().set_orbit_centre(on->position_world);
  turns_about_ = adds && !on ? after.active : 0;
  if (!held.empty() || !any_mark(*after.active_object())) ws_.tools.disarm_scale();
  if (!held.empty()) cuts_.note_so_already(cut_key(after, *after.active_object()));
  edits_.push(c.title(), std::move(after), {}, held.empty() ? message : held);
}

void Clicks::perform(const RemoveStroke& c) {
  ws_.require_scene();
  Document after = ws_.document();
  const std::string message = edit(&after, c, ws_.context());
  take_back_sharing(ws_.history, c, &after, ws_.gaussians(), &ws_.labels);
  edits_.push(c.title(), std::move(after), {}, message);
}

bool Clicks::found_nothing() const {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || !any_mark(*object)) return false;  // nothing was sought
  const CutRun* run = cuts_.run(ws_.document().active);
  return run && !run->running && run->result && run->result->outcome == Outcome::kNothingFound;
}

// Moves to a third of the distance from what was clicked, which comes to the middle.
void Clicks::perform(const ComeNearer&) {
  ws_.require_scene();
  constexpr float kDistanceLeft = 1.0f / 3;
  const ObjectItem* object = ws_.document().active_object();
  if (!object || !any_mark(*object)) throw Error("", "Nothing is clicked yet", "Click an object first");
  const auto clicked = std::ranges::find_if(object->views, marks_object);
  const Stroke& stroke = *std::ranges::find(clicked->strokes, SeedLabel::kObject, &Stroke::label);
  std::vector<glm::vec2> points = stroke.points_px;
  if (stroke.is_box()) points = {0.5f * (points[0] + points[1])};
  std::optional<PickedPoint> hit;
  for (const glm::vec2& p : points)
    if ((hit = viewport_.hit_in(clicked->camera, p, nullptr))) break;
  if (!hit) throw Error("", "There is nothing in that place");
  viewport_.camera().approach(hit->position_world, kDistanceLeft);
}

// A refusal if the last click has no part that many sizes larger, as far as is known; else empty.
std::string Clicks::why_not_step(int steps) const {
  const ObjectItem* object = ws_.document().active_object();
  if (!object || !any_mark(*object)) return "Click an object first";
  const StrokeSizes* known = known_sizes();
  if (!known) {
    const Stroke* last = last_stroke(object->views);
    const bool may_have = last->is_click() || last == first_stroke(object->views);
    const CutRun* run = cuts_.run(object->id);
    return !may_have ? "The last stroke has no sizes: only clicks have, and what began the object"
           : cuts_.comes(*object) || !run ? ""
           : run->changed_nothing         ? "The last click changed nothing, so it has no other size"
                                          : "The last click has no other size: scribble over what is meant";
  }
  const std::size_t size = size_wanted(), last = known->count() - 1;
  if (last == 0) return why_one_size(steps, last_takes_away(object->views));
  const bool at_end = steps > 0 ? size >= last : size == 0;
  return at_end ? why_no_further(steps) : "";
}

std::string Clicks::why_no_further(int steps) const {
  const ObjectItem& object = *ws_.document().active_object();
  if (last_takes_away(object.views))
    return steps > 0 ? "The click takes no more away than this: right-click what is left"
                     : "The click takes no less away than this: click what shall come back";
  return steps > 0 ? why_no_larger(ws_.gaussians_of(object.id), ws_.gaussians())
                   : "This is the smallest size: right-click what does not belong to it";
}

// That many sizes on, past those that are known to change nothing here, as other strokes or objects hold what
// they would take. 0: none is left.
int Clicks::step_that_changes(int step) const {
  const StrokeSizes& known = *known_sizes();
  const auto likeliest = static_cast<int>(known.likeliest), now = static_cast<int>(size_wanted());
  for (int size = now + step; size >= 0 && size < static_cast<int>(known.count()); size += step)
    if (!cuts_.changes_nothing(size - likeliest)) return size - now;
  return 0;
}

void Clicks::perform(const StepScale& c) {
  ws_.require_scene();
  const std::string reason = why_not_step(c.steps);
  if (!reason.empty()) throw Error("", reason);
  Document after = ws_.document();
  const StrokeSizes* known = known_sizes();
  const auto limit = [&] {  // steps made before the sizes were known
    const auto likeliest = static_cast<int>(known->likeliest), sizes = static_cast<int>(known->count());
    int& step = last_stroke(&after.find(after.active)->views)->size_step;
    step = std::clamp(step, -likeliest, sizes - 1 - likeliest);
  };
  if (known) limit();
  const bool next = known && std::abs(c.steps) == 1;  // of wheel and keys
  const StepScale taken{next ? step_that_changes(c.steps) : c.steps};
  if (taken.steps == 0 && c.steps != 0) throw Error("", why_no_further(c.steps));
  const std::string message = edit(&after, taken, ws_.context());
  if (known) limit();
  stepped_s_ = ws_.clock_s;
  edits_.push(taken.title(ws_.document()), std::move(after), {}, message);
}

// Whether the next click is thought about: by a click tool, in a still picture, while no cut runs.
bool Clicks::asks_ahead() const {
  return tool_of(ws_.view.tool).clicks_object && can_ask();
}

bool Clicks::can_ask() const {
  const ObjectItem* active = ws_.document().active_object();
  const bool has_room = active || ws_.document().objects.size() < kMostObjects;
  if (!ws_.session || !has_room || viewport_.panes() != 1 || ws_.view.heat || ws_.tools.dragging() ||
      viewport_.floaters_shown() || viewport_.range_shown() || cuts_.cutting() != 0 ||
      (active && active->locked))
    return false;
  return viewport_.style_current() && viewport_.full_picture_of(viewport_.pane_camera());
}

const StrokeMark* Clicks::pointed_mark() const {
  const ObjectItem* object = ws_.document().active_object();
  if (!pointer_inside_ || !tool_of(ws_.view.tool).clicks_object || ws_.tools.dragging() ||
      ws_.tools.at_last_click() || !object || object->locked)
    return nullptr;
  return viewport_.mark_at(ws_.tools.pointer_px());
}

bool Clicks::on_last_dot() const {
  const ObjectItem* object = ws_.document().active_object();
  const StrokeMark* mark = viewport_.mark_at(ws_.tools.pointer_px());
  if (!object || !mark || !mark->from_here || !tool_of(ws_.view.tool).clicks_object ||
      mark->view >= object->views.size())
    return false;
  const Strokes& strokes = object->views[mark->view].strokes;
  return mark->stroke < strokes.size() && &strokes[mark->stroke] == last_stroke(object->views);
}

// Nothing without a hit under the pointer.
std::optional<Clicks::HoverAsk> Clicks::hover_wanted() const {
  const bool by_colour = tool_of(ws_.view.tool).selects == Tool::Selects::kColours;
  // On the dot of the last click the sizes of it are outlined, not what the next one changes; and who has not
  // moved since looks at what came of it.
  if (!pointer_inside_ || (by_colour ? !can_ask() : !asks_ahead()) || pointed_mark() ||
      (on_last_dot() && (sizes() || ws_.tools.at_last_click())))
    return {};
  // Who turned outlines off wants to see the result as it is.
  if (!ws_.view.outline && ws_.view.display != DisplayMode::kWhole) return {};
  const ObjectItem* active = ws_.document().active_object();
  const Camera camera = viewport_.pane_camera();
  const auto hit = viewport_.pick(ws_.tools.pointer_px());
  if (!hit) return {};
  const glm::vec2 pixel = glm::floor(ws_.tools.pointer_px());
  if (by_colour) {
    const SetOperation operation =
        ws_.tools.overlay(ws_.view, camera, viewport_.pixels_per_point()).operation;
    return HoverAsk{ws_.history.serial(), ws_.view_serial, camera, pixel, operation != SetOperation::kAdd,
                    hit->gaussian,        operation};
  }
  const bool on_object =
      viewport_.active_labels() && (*viewport_.active_labels())[static_cast<std::size_t>(hit->gaussian)] != 0;
  const bool corrects = active && any_mark(*active);
  return HoverAsk{ws_.history.serial(),
                  ws_.view_serial,
                  camera,
                  pixel,
                  corrects && (on_object || ws_.held_modifiers.ctrl),
                  hit->gaussian};
}

bool Clicks::looking() const {
  constexpr double kAtOnceSeconds = 0.4;
  return hover_ && ws_.tasks.busy(TaskKind::kHover) && ws_.clock_s - hover_asked_s_ > kAtOnceSeconds;
}

// True from a change of the display or the background until the pointer moves: one looks at the picture. It
// may have moved since that change before this is asked.
bool Clicks::looks_only() {
  const Look look{ws_.view.display, ws_.view.checker, ws_.document().background};
  const glm::vec2 pointer_px = ws_.tools.pointer_px(), before_px = std::exchange(looked_px_, pointer_px);
  if (std::exchange(look_, look) != look) looks_only_px_ = before_px;
  if (looks_only_px_ != pointer_px) looks_only_px_.reset();
  return looks_only_px_.has_value();
}

// Outlines what a click would change: outside of the object a click that adds, on it one that removes. The
// worker does what the click would; the newest place is asked for once it is free.
void Clicks::refresh_hover() {
  const std::optional<HoverAsk> ask = looks_only() ? std::nullopt : hover_wanted();
  if (!ask) {
    if (hover_) show_hover(nullptr, false);
    hover_.reset();
    return;
  }
  if (hover_ && hover_->same_but_pixel(*ask) && hover_->pixel == ask->pixel) return;
  constexpr float kElsewherePoints = 40;  // what was outlined there is not meant any more
  if (hover_ && glm::distance(hover_->pixel, ask->pixel) > kElsewherePoints * viewport_.pixels_per_point())
    show_hover(nullptr, false);
  if (ws_.tasks.busy(TaskKind::kHover)) return;
  hover_ = ask;
  hover_asked_s_ = ws_.clock_s;
  if (ask->by_colour) return ask_by_colour(*ask);
  const ObjectItem* object = ws_.document().active_object();
  const ObjectItem none;
  CameraStroke stroke{ask->camera,
                      click(ws_.tools.pointer_px(), ask->rest ? SeedLabel::kRest : SeedLabel::kObject),
                      viewport_.seen(0)};
  stroke.stroke.radius_px *= viewport_.pixels_per_point();
  CutRequest request = cut_request(ws_.document(), object ? *object : none);
  if (object) {
    stroke.camera = known_camera(*object, stroke.camera);
    if (!ask->rest && reaches_beyond(*object, {&ask->on, 1})) request.among = nullptr;
  }
  if (!shows_clean_edges(ws_.view) && !shows_filled_hole(ws_.view))
    ws_.tasks.cancel(TaskKind::kClean);  // nobody waits for it
  ws_.tasks.cancel(TaskKind::kAhead);
  ws_.tasks.submit(
      TaskKind::kHover,
      [this, ask = *ask, stroke, session = ws_.session, scene = ws_.scene, document = ws_.document(),
       left = hover_left_.document == ask->document ? std::optional(hover_left_.left) : std::nullopt, request,
       settings = cut_settings(ws_.document(), object ? *object : none)](const Job& job) mutable {
        const Session::Preview preview = session->preview(request, stroke, settings, job);
        if (preview.after.empty() || job.cancelled()) return;
        const AddStroke click{stroke.camera, stroke.stroke, stroke.seen, {ask.on}};
        const EditContext context{*scene->cloud};
        if (!left) left = left_by_stroke(document, context);
        if (job.cancelled()) return;
        const Flags change = changed_by(document, click, preview.before, preview.after, *left, context);
        ws_.tasks.post([this, ask, scene, change, left = *left] {
          hover_left_ = {ask.document, left};
          if (scene == ws_.scene && hover_ && hover_->same_but_pixel(ask)) show_hover(change, ask.rest);
        });
      });
}

// What the eyedropper or the flood would change, as Edits does it.
void Clicks::ask_by_colour(const HoverAsk& ask) {
  const Flags before = viewport_.active_labels(), shown = viewport_.shown(0);
  ws_.tasks.submit(TaskKind::kHover, [this, ask, before, shown, scene = ws_.scene, graph = ws_.graph,
                                      floods = ws_.view.tool == Tool::kFlood,
                                      tolerance = ws_.view.colour_tolerance](const Job& job) {
    const GaussianCloud& cloud = *scene->cloud;
    const auto on = static_cast<std::size_t>(ask.on);
    const Selection region = floods
                                 ? select_flood(cloud, graph->get(job), on, tolerance,
                                                shown ? std::span(*shown) : std::span<const std::uint8_t>())
                                 : select_colour(cloud, base_colour(cloud, on), tolerance);
    Selection change = combined(*before, region, *ask.by_colour);
    for (std::size_t g = 0; g < change.size(); ++g) change[g] = change[g] != (*before)[g];
    ws_.tasks.post([this, ask, scene, change = make_flags(std::move(change))] {
      if (scene == ws_.scene && hover_ && hover_->same_but_pixel(ask)) show_hover(change, ask.rest);
    });
  });
}

// Where nothing else is done and no object is begun, what a first click needs is built: where the pointer
// rests, then in the neighbourhood of what the picture shows in its middle.
void Clicks::make_ready() {
  const ObjectItem* active = ws_.document().active_object();
  if (!asks_ahead() || !ws_.tasks.idle() || (active && any_mark(*active))) return;
  const Camera camera = viewport_.pane_camera();
  if (!ready_.camera || !same_camera(*ready_.camera, camera)) ready_ = {camera, {}, {}};
  const glm::vec2 middle_px = 0.5f * glm::vec2(camera.width_px, camera.height_px);
  const bool for_pointer = hover_ && ready_.pointer_px != hover_->pixel;
  std::optional<glm::vec2>& last_px = for_pointer ? ready_.pointer_px : ready_.middle_px;
  const glm::vec2 place_px = for_pointer ? hover_->pixel : middle_px;
  if (last_px == place_px) return;
  last_px = place_px;
  const glm::vec2 at_px =
      for_pointer ? ws_.tools.pointer_px() : middle_px;  // as the hover asked and a click would
  if (!viewport_.pick(at_px)) return;
  CameraStroke stroke{camera, click(at_px, SeedLabel::kObject), viewport_.seen(0)};
  stroke.stroke.radius_px *= viewport_.pixels_per_point();
  ws_.tasks.submit(TaskKind::kReady,
                   [stroke, session = ws_.session, settings = cut_settings(ws_.document(), ObjectItem{})](
                       const Job& job) { session->make_ready(stroke, settings, job); });
}

void Clicks::show_hover(const Flags& change, bool rest) {
  constexpr Rgb8 kAdds{255, 255, 255}, kRemoves{225, 25, 60};
  viewport_.highlight(change, rest ? kRemoves : kAdds);
}

// What objects get whose cut was on its way when another was begun is left to them, too. One that is gone
// now, or whose cut was given up, may still come.
void Clicks::leave_what_came() {
  const Document& document = ws_.document();
  for (const ObjectItem& object : document.objects) {
    std::vector<ObjectId> came;
    for (const ObjectId id : object.leaves_also)
      if (const ObjectItem* other = document.find(id);
          other && !is_stale(*other, ws_.history.keys(*other).cut))
        came.push_back(id);
    if (came.empty()) continue;
    const auto hits = [&] { return hits_of(object, viewport_.drawn_part()); };
    return leave_in_history(&ws_.history, object,
                            left_what_came(document, object, came, hits, ws_.gaussians(), &ws_.labels), came);
  }
}

// Where no surface was hit, as by a box or a click on fog, the view turns around what came of it.
void Clicks::turn_about_cut() {
  const ObjectItem* object = turns_about_ != 0 ? ws_.document().active_object() : nullptr;
  if (!object || object->id != turns_about_) {
    turns_about_ = 0;
    return;
  }
  if (edits_.waiting() || cuts_.comes(*object)) return;
  turns_about_ = 0;
  viewport_.turn_about_object();
}

void Clicks::update() {
  if (!declined_offer_.empty()) forget_declined();
  leave_what_came();
  turn_about_cut();
  if (std::exchange(cuts_done_, cuts_.done()) != cuts_.done()) note_sizes();
  refresh_hover();
  if (!ws_.options.works_ahead) return;
  make_ready();
  cut_sizes_ahead();
}

void Clicks::reset() {
  hover_.reset();
  ready_ = {};
  declined_offer_.clear();
  turns_about_ = 0;
}

}  // namespace splatcut
