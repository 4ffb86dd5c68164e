// The subcommands of the program. Each adds itself to the command line; its work runs from the callback.
#pragma once

#include <CLI/CLI.hpp>

namespace splatcut {

// What every subcommand shares.
struct CommonOptions {
  int threads = 0;  // 0: all cores
  bool quiet = false;
};

void add_info_command(CLI::App& program, const CommonOptions& common);
void add_render_command(CLI::App& program, const CommonOptions& common);
void add_convert_command(CLI::App& program, const CommonOptions& common);
void add_cut_command(CLI::App& program, const CommonOptions& common);
void add_make_scene_command(CLI::App& program, const CommonOptions& common);
void add_eval_command(CLI::App& program, const CommonOptions& common);
void add_compare_command(CLI::App& program, const CommonOptions& common);
void add_view_command(CLI::App& program, const CommonOptions& common);

}  // namespace splatcut
