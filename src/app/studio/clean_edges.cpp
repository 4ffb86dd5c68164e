#include "app/studio/clean_edges.h"

#include <fmt/format.h>

#include <utility>

#include "app/document/export_plan.h"
#include "app/document/words.h"

namespace splatcut {

namespace {

// Of an object that Clean leaves as it is: why, and what its button does then.
std::string uncleaned_text(const std::string& name, const std::string& why_not) {
  return fmt::format("Clean edges leave {} as it is: {}", name, why_not);
}

}  // namespace

void CleanEdges::update() {
  constexpr double kCalmSeconds = 1;
  if (!ws_.scene || !viewport_.style_current() || cuts_.cutting() != 0) return;
  const Flags& labels = viewport_.active_labels();
  if (std::exchange(seen_, labels) != labels || !ws_.tasks.idle()) seen_since_s_ = ws_.clock_s;
  const bool ahead = ws_.clock_s - seen_since_s_ > kCalmSeconds && ws_.options.works_ahead;
  for (const bool fills : {shows_filled_hole(ws_.view), !shows_filled_hole(ws_.view)}) {
    if (!std::exchange(shown_[fills ? 1 : 0], shows(fills)) && shows(fills)) given_up(fills) = {};
    const bool wanted = fills ? ws_.view.fill_hole : ws_.view.clean_edges;
    if (shows(fills) || (ahead && wanted)) ask(fills);
  }
}

bool CleanEdges::shows(bool fills) const {
  return fills ? shows_filled_hole(ws_.view) : shows_clean_edges(ws_.view);
}

CleanEdges::Asked CleanEdges::asked(bool fills) const {
  return {fills, leaving_of(ws_.document(), seen_, ws_.view)};
}

bool CleanEdges::known(const Asked& asked) const {
  return asked.fills ? ws_.clean->known_without(asked.leaving) != nullptr
                     : ws_.clean->known(asked.leaving.labels, asked.leaving.up_world) != nullptr;
}

bool CleanEdges::computes(bool fills) const {
  return ws_.tasks.busy(TaskKind::kClean) && fills_ == fills;
}

void CleanEdges::ask(bool fills) {
  if (!seen_) return;
  const Asked now = asked(fills);
  if (known(now)) {  // an export made it, too
    const bool waits = shows(fills) && viewport_.style_current() && viewport_.styles().unfinished;
    if (waits && std::exchange(shown_again_[fills ? 1 : 0], now) != now) ++ws_.view_serial;
    return;
  }
  if (given_up(fills) == now || !ws_.tasks.idle()) return;
  if (count_flags(*seen_) > 0)
    start(now);
  else
    given_up(fills) = now;
}

void CleanEdges::start(const Asked& asked) {
  fills_ = asked.fills;
  const TaskThread::Order order(TaskKind::kClean, [this, asked] { given_up(asked.fills) = asked; });
  ws_.tasks.submit(order, [this, asked, clean = ws_.clean](const Job& job) {
    const Leaving& of = asked.leaving;
    if (asked.fills)
      clean->made_without(of, job);
    else
      clean->made(of.labels, of.up_world, job);
    if (job.cancelled()) return;
    ws_.tasks.post([this, asked, clean] {
      if (clean != ws_.clean || !known(asked)) return;
      ++ws_.view_serial;
      const auto object = clean->known(asked.leaving.labels, asked.leaving.up_world);
      const ObjectItem* active = ws_.document().active_object();
      if (object && active && !asked.fills && !object->report.cleaned && shows(false))
        ws_.say_also(Message::Kind::kInfo, uncleaned_text(active->name, object->report.why_not));
    });
  });
}

bool CleanEdges::cancel() {
  const bool fills = shows_filled_hole(ws_.view);
  if (!shows(fills) || !computes(fills)) return false;
  ws_.tasks.cancel(TaskKind::kClean);
  given_up(fills) = asked(fills);
  return true;
}

std::shared_ptr<const SceneWithout> CleanEdges::without() const {
  const ObjectItem* object = ws_.document().active_object();
  if (!ws_.scene || !object) return nullptr;
  const Flags& labels = ws_.labels.labels(ws_.document(), *object, ws_.gaussians());
  return ws_.clean->known_without(leaving_of(ws_.document(), labels, ws_.view));
}

std::string CleanEdges::hole_text() const {
  if (!shows_filled_hole(ws_.view)) return {};
  const auto now = without();
  if (now && !now->patch.why_not.empty()) return "Not filled: " + now->patch.why_not + ".";
  if (ws_.gaussians() > kMostToCopy)
    return "This scene is too large to show it filled; exports of the rest fill it where they can.";
  if (now)
    return fmt::format("Filled by {}, all invented.", gaussians_text(now->patch.changes.given_back.size()));
  if (computes(true)) return "Filling the hole...  (Esc: stop)";
  const auto& before = viewport_.styles().without;
  return before && before->patch.why_not.empty() ? "Filled as before the last change." : "Not filled.";
}

}  // namespace splatcut
