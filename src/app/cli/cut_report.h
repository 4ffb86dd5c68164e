// What `splatcut cut` says of a run: report.json and its lines on the terminal.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/cli/cut_objects.h"
#include "app/cli/cutout_files.h"
#include "scene/formats/scene_file.h"

namespace splatcut {

struct RunReport {
  const Scene& scene;
  const nlohmann::json& settings;
  const std::vector<CutObject>& objects;  // one without a name, or several with names
  const CutoutOptions& options;           // which files were written
  std::vector<EdgesReport> edges = {};    // of each object
  RestReport rest = {};
  double load_ms = 0, total_ms = 0;  // the time that writing takes does not count
  bool times = true;                 // time, memory and what else depends on earlier cuts is told

  bool of_one() const { return objects.size() == 1 && objects.front().name.empty(); }
};

ObjectFiles files_of(const CutObject& object);

LostByFile lost_by_file(const RunReport& report);  // of all files written

nlohmann::json report_json(const RunReport& report);
std::string summary(const RunReport& report);  // lines on the objects

}  // namespace splatcut
