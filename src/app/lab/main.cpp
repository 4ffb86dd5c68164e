#include "app/lab/lab_commands.h"

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
  const splatcut::CommandLine line{
      "splatcut-lab", "Measure splatcut: scenes with known labels, simulated users, scores and charts",
      "splatcut-lab eval suite.json -o measured",
      [](CLI::App& program, const splatcut::CommonOptions& common) {
        add_eval_command(program, common);
        add_fit_command(program, common);
        add_click_chart_command(program, common);
        add_study_command(program, common);
        add_make_scene_command(program, common);
      }};
  return splatcut::run_command_line(line, {argv + 1, argv + argc});
}
