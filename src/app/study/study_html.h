// Small pieces of HTML.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace splatcut {

inline std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<'   ? std::string("&lt;")
           : c == '"' ? std::string("&quot;")
           : c == '&' ? std::string("&amp;")
                      : std::string(1, c);
  return out;
}

inline std::string row_of(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string html = "<tr>";
  for (const std::string& cell : cells) html += fmt::format("<{0}>{1}</{0}>", tag, escaped(cell));
  return html + "</tr>\n";
}

inline std::string iou_text(double iou) {
  return fmt::format("{:.3f}", iou);
}

}  // namespace splatcut
