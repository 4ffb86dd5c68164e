// The subcommands of splatcut-lab. Each adds itself to the command line; its work runs from the callback.
#pragma once

#include <optional>

#include "app/console/command_line.h"

namespace CLI {
class Option;
}

namespace splatcut {

void add_make_scene_command(CLI::App& program, const CommonOptions& common);
void add_eval_command(CLI::App& program, const CommonOptions& common);
void add_fit_command(CLI::App& program, const CommonOptions& common);
void add_click_chart_command(CLI::App& program, const CommonOptions& common);
void add_study_command(CLI::App& program, const CommonOptions& common);

// --from-box of eval and fit: see FirstStrokes.
CLI::Option* add_box_option(CLI::App& command, std::optional<float>* margin);

}  // namespace splatcut
