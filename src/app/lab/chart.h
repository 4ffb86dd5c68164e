// A chart as files: its points as CSV, the gnuplot script that draws them, SVG and PNG.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace splatcut {

struct ChartName {
  std::string name, title;  // name.csv, name.gp, name.svg, name.png in the folder
};

// The points of a chart as blocks of CSV, a block a line of the chart, and what gnuplot does with them.
struct Chart {
  ChartName named;
  std::string csv, commands;  // commands: read `data`, blocks 0 to `last`
  std::size_t blocks = 1;
  int width_px = 980, height_px = 560;
};

// The text as gnuplot reads it: in single quotes.
std::string gnuplot_text(const std::string& text);

// Throws Error where a file cannot be written, or gnuplot is not there or fails.
void draw_chart(const Chart& chart, const std::filesystem::path& folder);

}  // namespace splatcut
