#include "app/cli/cut_report.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/console/version.h"
#include "app/document/export_plan.h"
#include "segment/masks/mask_tools.h"

namespace splatcut {

namespace {

using nlohmann::json;

double peak_rss_mb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::size_t gaussians_of(const CutObject& object) {
  return static_cast<std::size_t>(std::ranges::count(object.result.labels, 1));
}

// Views, cut and stages of an object.
json cut_json(const CutObject& object, const std::vector<StageTime>& times, bool with_times) {
  const CutResult& result = object.result;
  json views = json::array(), stages = json::array();
  for (const ViewReport& view : result.views) {
    views.push_back({{"used", view.used}, {"confidence", view.confidence}, {"mask_px", count(view.mask)}});
    if (!view.reason.empty()) views.back()["reason"] = view.reason;
  }
  for (const StageTime& stage : times) stages.push_back({{"name", stage.name}, {"ms", stage.ms}});
  const LookedAt enough = looked_at(result.views);
  json out = {{"views", views},
              {"enough", {{"views", enough.views}, {"pixels", enough.pixels}, {"why", result.why_enough}}},
              {"cut",
               {{"nodes", result.cut.nodes},
                {"arcs", result.cut.arcs},
                {"energy", result.cut.energy},
                {"flow", result.cut.flow}}},
              {"certainty", result.certainty},
              {"doubts", object.doubts()}};
  if (!result.meanings.empty())
    out.update({{"choice", result.choice + 1}, {"choices", result.meanings.size()}});
  if (!with_times) return out;
  out["enough"]["gaussians"] = result.cut.touched;  // fewer where the session cut there before
  out["stages"] = stages;
  return out;
}

json entry_json(const RunReport& report, std::size_t o) {
  const CutObject& object = report.objects[o];
  const ObjectFiles files = files_of(object);
  json entry = cut_json(object, object.result.stages, report.times);
  entry.update({{"name", object.name},
                {"index", o + 1},
                {"camera", object.camera.name},
                {"gaussians", gaussians_of(object)},
                {"left_to_later", object.found - gaussians_of(object)},
                {"edges", report.edges[o].json(report.times)}});
  if (report.options.writes("object")) entry["file"] = files.scene;
  if (report.options.writes("labels")) entry["labels"] = files.labels;
  return entry;
}

// All that a run of one object spent its time on.
std::vector<StageTime> stages_of_one(const RunReport& report) {
  std::vector<StageTime> stages = report.objects.front().result.stages;
  stages.insert(stages.begin(), {"load", report.load_ms});
  stages.push_back({"edges", report.edges.front().ms});
  stages.push_back({"seen", report.edges.front().seen_ms});
  return stages;
}

}  // namespace

ObjectFiles files_of(const CutObject& object) {
  return object.name.empty() ? files_of_only_object() : files_of_object(file_name_of(object.name));
}

LostByFile lost_by_file(const RunReport& report) {
  LostByFile lost = report.rest.lost;
  for (std::size_t o = 0; o < report.objects.size(); ++o)
    if (!report.edges[o].lost.empty()) lost[files_of(report.objects[o]).scene] = report.edges[o].lost;
  return lost;
}

json report_json(const RunReport& report) {
  const Scene& scene = report.scene;
  json out = {{"version", version()},
              {"settings", report.settings},
              {"scene",
               {{"gaussians", scene.cloud.size()},
                {"file_rows", scene.file_rows},
                {"dropped", scene.dropped},
                {"origin", {scene.origin.x, scene.origin.y, scene.origin.z}}}}};
  if (report.times) out.update({{"total_ms", report.total_ms}, {"peak_rss_mb", peak_rss_mb()}});
  if (const LostByFile lost = lost_by_file(report); !lost.empty()) out["lost"] = lost;
  if (report.of_one()) {
    const CutObject& object = report.objects.front();
    out.update(cut_json(object, stages_of_one(report), report.times));
    out.update({{"object", {{"gaussians", gaussians_of(object)}}},
                {"edges", report.edges.front().json(report.times)}});
    return out;
  }
  out.update({{"objects", json::array()}, {"rest", {{"gaussians", report.rest.gaussians}}}});
  if (report.times) out["stages"] = {{{"name", "load"}, {"ms", report.load_ms}}};
  for (std::size_t o = 0; o < report.objects.size(); ++o) out["objects"].push_back(entry_json(report, o));
  return out;
}

std::string summary(const RunReport& report) {
  const std::size_t all = report.scene.cloud.size();
  std::string text;
  if (!report.of_one()) {
    for (const CutObject& o : report.objects)
      text += fmt::format("{}: {} of {} Gaussians\n",
                          report.options.writes("object") ? files_of(o).scene : o.name, gaussians_of(o), all);
    return text;
  }
  text = fmt::format("{} of {} Gaussians cut out in {:.0f} ms\n", gaussians_of(report.objects.front()), all,
                     report.total_ms);
  if (const auto& seen = report.edges.front().seen; seen && !seen->never().empty())
    text += fmt::format("never seen from {}; by its six sides, no view saw {:.0f} % of its surface\n",
                        fmt::join(seen->never(), ", "), 100 * seen->unseen_share());
  if (const std::string said = report.edges.front().sentence(); !said.empty()) text += said + "\n";
  for (const StageTime& stage : stages_of_one(report))
    text += fmt::format("  {:<16} {:8.0f} ms\n", stage.name, stage.ms);
  return text;
}

}  // namespace splatcut
