// splatcut view of a program that was built without its window.
#include <CLI/CLI.hpp>

#include "app/cli/commands.h"
#include "core/error.h"

namespace splatcut {

void add_view_command(CLI::App& program, const CommonOptions&) {
  CLI::App& command = *program.add_subcommand("view", "Open the window: not in this program");
  command.fallthrough(false)->allow_extras();  // whatever the window would have been told
  command.callback([] {
    throw Error("window", "this splatcut was built without one (SPLATCUT_WINDOW=OFF)",
                "Use cut, render or convert");
  });
}

}  // namespace splatcut
