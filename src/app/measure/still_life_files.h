// A still life as files: scene, labels, cameras, seeds and a suite of its objects.
#pragma once

#include <string>

#include "app/console/output_folder.h"
#include "scene/still_life/still_life.h"

namespace splatcut {

// NAME.FORMAT, NAME.labels.u8, cameras.json, seeds.json, suite.json.
void write_still_life(const OutputFolder& folder, const LabelledScene& made, const std::string& name,
                      const std::string& format);

}  // namespace splatcut
