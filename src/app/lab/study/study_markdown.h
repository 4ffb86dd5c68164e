// Small pieces of Markdown.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace splatcut {

// A row of a table; what would end its cell is escaped.
inline std::string row_of(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) {
    row += ' ';
    for (const char c : cell) row += c == '|' ? std::string("\\|") : std::string(1, c == '\n' ? ' ' : c);
    row += " |";
  }
  return row + "\n";
}

// The first two rows of a table.
inline std::string head_of(const std::vector<std::string>& cells) {
  std::string rows = "\n";
  rows += row_of(cells);
  rows += row_of(std::vector<std::string>(cells.size(), "---"));
  return rows;
}

inline std::string iou_text(double iou) {
  return fmt::format("{:.3f}", iou);
}

}  // namespace splatcut
