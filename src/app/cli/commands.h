// The subcommands of splatcut. Each adds itself to the command line; its work runs from the callback.
#pragma once

#include "app/console/command_line.h"

namespace splatcut {

void add_info_command(CLI::App& program, const CommonOptions& common);
void add_render_command(CLI::App& program, const CommonOptions& common);
void add_convert_command(CLI::App& program, const CommonOptions& common);
void add_merge_command(CLI::App& program, const CommonOptions& common);
void add_cut_command(CLI::App& program, const CommonOptions& common);
void add_batch_command(CLI::App& program, const CommonOptions& common);
void add_serve_command(CLI::App& program, const CommonOptions& common);
void add_compare_command(CLI::App& program, const CommonOptions& common);
void add_view_command(CLI::App& program, const CommonOptions& common);

}  // namespace splatcut
