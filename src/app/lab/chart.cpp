#include "app/lab/chart.h"

#include <fmt/format.h>

#include "app/console/run_program.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace splatcut {

// An apostrophe is written twice.
std::string gnuplot_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

void draw_chart(const Chart& chart, const std::filesystem::path& folder) {
  const std::string& name = chart.named.name;
  write_text_file(folder / (name + ".csv"), chart.csv);
  write_text_file(
      folder / (name + ".gp"),
      fmt::format("data = '{0}.csv'\nlast = {1}\nset datafile separator ','\n"
                  "set key autotitle columnhead\nset key outside right top\nset grid\nset title {2}\n"
                  "set terminal svg noenhanced font 'sans,13' background 'white' size {3},{4}\n"
                  "set output '{0}.svg'\n{5}set terminal pngcairo noenhanced font 'sans,10' size "
                  "{3},{4}\nset output '{0}.png'\nreplot\n",
                  name, chart.blocks - 1, gnuplot_text(chart.named.title), chart.width_px, chart.height_px,
                  chart.commands));
  const ProgramEnd end =
      run_program({"gnuplot", "-e", "cd " + gnuplot_text(folder.string()), name + ".gp"}, {});
  if (end.exit_code != 0)
    throw Error("gnuplot",
                end.start_error ? "cannot be started"
                                : fmt::format("ended with code {} on {}", end.exit_code, name + ".gp"),
                "Install gnuplot-nox; the measurements are kept, run the same command again");
}

}  // namespace splatcut
