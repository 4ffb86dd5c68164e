// splatcut-lab click-chart: image IoU by number of clicks, drawn from what eval --any-view has measured.
//
// clicks.csv has a block a suite and one of all of them, in rows of clicks, IoU (mean over the objects, each
// the mean over its sessions) and share of the sessions that reached .9 with at most so many clicks.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>

#include "app/console/kept_inputs.h"
#include "app/console/output_folder.h"
#include "app/lab/chart.h"
#include "app/lab/lab_commands.h"
#include "app/lab/study/study_markdown.h"
#include "app/lab/study/study_tables.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

constexpr double kReached = 0.9;  // NoC90's goal

struct ClickChartArguments {
  std::vector<std::filesystem::path> results;
  std::filesystem::path output;
  bool overwrite = false;
};

// Sums over objects; `reached` over sessions.
struct ClickCurve {
  std::string name;
  double objects = 0, sessions = 0, noc85 = 0, noc90 = 0;
  std::vector<double> iou, reached;  // after 1, 2, ... clicks
};

void add_object(const nlohmann::json& robot, ClickCurve* curve) {
  const nlohmann::json& sessions = robot.at("sessions");
  for (const nlohmann::json& session : sessions) {
    const std::vector<double> after = session.at("iou_after");
    if (curve->sessions++ == 0) curve->iou = curve->reached = std::vector<double>(after.size());
    if (after.size() != curve->iou.size())
      throw Error(curve->name, fmt::format("has a session of {} clicks beside one of {}", after.size(),
                                           curve->iou.size()));
    double most = 0;
    for (std::size_t k = 0; k < after.size(); ++k) {
      most = std::max(most, after[k]);
      curve->iou[k] += after[k] / static_cast<double>(sessions.size());
      curve->reached[k] += most >= kReached ? 1 : 0;
    }
  }
  ++curve->objects;
  curve->noc85 += robot.at("noc85").get<double>();
  curve->noc90 += robot.at("noc90").get<double>();
}

// A curve a file, named after its folder, and the one of all objects.
std::vector<ClickCurve> click_curves(const std::vector<std::filesystem::path>& files) {
  std::vector<ClickCurve> curves;
  ClickCurve all{.name = "all"};
  for (const std::filesystem::path& file : files) try {
      curves.push_back({.name = std::filesystem::absolute(file).parent_path().filename().string()});
      const nlohmann::json result = json_of_file(file);
      for (const nlohmann::json& scene : result.at("scenes")) {
        add_object(scene.at("any_view"), &curves.back());
        add_object(scene.at("any_view"), &all);
      }
      if (curves.back().iou.empty()) throw Error(file.string(), "has no session of the any-view robot");
    } catch (const nlohmann::json::exception& error) {
      throw Error(file.string(), "is no eval.json of eval --any-view (" + fault_of(error) + ")");
    }
  curves.push_back(std::move(all));
  return curves;
}

Chart click_chart(const std::vector<ClickCurve>& curves) {
  Chart chart{.named = {"clicks", "Image IoU by number of clicks"}, .blocks = curves.size()};
  for (const ClickCurve& c : curves) {
    chart.csv +=
        fmt::format("{}{},iou,reached_90\n", chart.csv.empty() ? "" : "\n\n",
                    csv_field(fmt::format("{}: {} object{}", c.name, c.objects, c.objects > 1 ? "s" : "")));
    for (std::size_t k = 0; k < c.iou.size(); ++k)
      chart.csv += fmt::format("{},{},{}\n", k + 1, c.iou[k] / c.objects, c.reached[k] / c.sessions);
  }
  chart.commands = fmt::format(
      "set key inside bottom right\nset xlabel 'clicks'\nset xrange [0.8:{}.2]\nset xtics 1\n"
      "set ylabel 'image IoU (mean over the objects)'\nset yrange [*:1]\n"
      "plot data index last using 1:2 with linespoints pt 7 lw 4 lc rgb '#222222' title columnheader(1), \\\n"
      "     data index last using 1:3 with lines dt 2 lw 3 lc rgb '#222222' title 'share of all sessions "
      "that reached {:g}', \\\n"
      "     for [i=0:last-1] data index i using 1:2 with linespoints pt 7 ps 0.6 lw 2 lc i+1+(i>3) title "
      "columnheader(1)\n",
      curves.back().iou.size(), kReached);
  return chart;
}

std::string click_table(const std::vector<ClickCurve>& curves) {
  std::vector<std::string> heads = {"suite", "objects"};
  for (std::size_t k = 1; k <= curves.back().iou.size(); ++k) heads.push_back(std::to_string(k));
  heads.insert(heads.end(), {"NoC85", "NoC90"});
  std::string table = head_of(heads);
  for (const ClickCurve& c : curves) {
    std::vector<std::string> cells = {c.name, fmt::format("{}", c.objects)};
    for (const double iou : c.iou) cells.push_back(iou_text(iou / c.objects));
    for (const double noc : {c.noc85, c.noc90}) cells.push_back(fmt::format("{:.1f}", noc / c.objects));
    table += row_of(cells);
  }
  return table;
}

void run_click_chart(const ClickChartArguments& args) {
  refuse_written_inputs(args.output, args.results);
  const std::vector<ClickCurve> curves = click_curves(args.results);
  OutputFolder folder(args.output, args.overwrite);
  draw_chart(click_chart(curves), folder.file(""));
  folder.commit();
  fmt::print("{}", click_table(curves));
}

}  // namespace

void add_click_chart_command(CLI::App& program, const CommonOptions& /*common*/) {
  auto args = std::make_shared<ClickChartArguments>();
  CLI::App& command = *program.add_subcommand(
      "click-chart", "Chart image IoU by number of clicks, from what eval --any-view measured");
  command.footer("Example: splatcut-lab click-chart photos/eval.json real/eval.json -o chart");
  command
      .add_option("results", args->results,
                  "eval.json files, a line of the chart each, named after their folders")
      ->required()
      ->check(CLI::ExistingFile);
  command.add_option("-o,--output", args->output, "Folder for clicks.csv, .gp, .svg and .png")->required();
  command.add_flag("--overwrite", args->overwrite, "Replace existing output");
  command.callback([args] { run_click_chart(*args); });
}

}  // namespace splatcut
