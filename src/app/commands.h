// The subcommands of the program. Each adds itself to the command line; its work runs from the callback.
#pragma once

#include <CLI/CLI.hpp>

#include "app/user_folders.h"
#include "segment/prepared_scene.h"

namespace splatcut {

// What every subcommand shares.
struct CommonOptions {
  int threads = 0;  // 0: all cores
  bool quiet = false;
  bool cache = true;  // scenes once prepared are kept in the user's cache folder
};

inline PreparedCache prepared_cache(const CommonOptions& common) {
  PreparedCache cache;
  if (common.cache) cache.folder = cache_folder();
  return cache;
}

void add_info_command(CLI::App& program, const CommonOptions& common);
void add_render_command(CLI::App& program, const CommonOptions& common);
void add_convert_command(CLI::App& program, const CommonOptions& common);
void add_cut_command(CLI::App& program, const CommonOptions& common);
void add_make_scene_command(CLI::App& program, const CommonOptions& common);
void add_study_command(CLI::App& program, const CommonOptions& common);
void add_eval_command(CLI::App& program, const CommonOptions& common);
void add_compare_command(CLI::App& program, const CommonOptions& common);
void add_view_command(CLI::App& program, const CommonOptions& common);

}  // namespace splatcut
