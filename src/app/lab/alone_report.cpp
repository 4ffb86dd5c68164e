#include "app/lab/alone_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace splatcut {

namespace {

nlohmann::json alone_json(const AloneScore& s) {
  return {{"iou", s.iou},
          {"boundary_iou_2px", s.boundary_iou_2px},
          {"boundary_iou_2pct", s.boundary_iou_2pct},
          {"psnr_black_db", s.psnr_black_db},
          {"psnr_magenta_db", s.psnr_magenta_db},
          {"ssim", s.ssim},
          {"halo", s.halo},
          {"missing", s.missing},
          {"alpha_error", s.alpha_error}};
}

}  // namespace

nlohmann::json cutout_json(const CutoutScore& s) {
  nlohmann::json clean = alone_json(s.clean);
  clean.update({{"cleaned", s.cleaned},
                {"ms", s.clean_ms},
                {"views", s.report.views},
                {"agreed", s.report.agreed},
                {"left", s.report.left},
                {"split", s.report.split},
                {"made_solid", s.report.made_solid},
                {"recoloured", s.report.recoloured}});
  return {{"alone", alone_json(s.kept)},
          {"clean", clean},
          {"rest", {{"ring_psnr_db", s.rest.ring_psnr_db}, {"ghost_gradient", s.rest.ghost_gradient}}}};
}

void print_alone(const nlohmann::json& result) {
  fmt::print("\n{:<16} {:<5} {:>6} {:>6} {:>6} {:>6} {:>7} {:>6} {:>6} {:>6} {:>6}\n", "alone", "edges",
             "IoU", "b 2px", "b 2%", "black", "magenta", "SSIM", "halo", "miss", "alpha");
  std::vector<nlohmann::json> rows = result.at("scenes");
  rows.push_back(result.at("mean"));
  for (const nlohmann::json& row : rows)
    for (const auto& [key, edges] : {std::pair{"alone", "keep"}, std::pair{"clean", "clean"}}) {
      if (!row.contains(key)) continue;
      const auto of = [&row, &key = key](const char* name) { return row.at(key).at(name).get<double>(); };
      fmt::print(
          "{:<16} {:<5} {:>6.3f} {:>6.3f} {:>6.3f} {:>6.2f} {:>7.2f} {:>6.3f} {:>6.3f} {:>6.3f} {:>6.3f}\n",
          row.value("name", ""), edges, of("iou"), of("boundary_iou_2px"), of("boundary_iou_2pct"),
          of("psnr_black_db"), of("psnr_magenta_db"), of("ssim"), of("halo"), of("missing"),
          of("alpha_error"));
    }
}

}  // namespace splatcut
