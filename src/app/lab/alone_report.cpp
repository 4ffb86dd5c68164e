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

nlohmann::json rest_json(const RestScore& s) {
  return {{"ring_psnr_db", s.ring_psnr_db}, {"ghost_gradient", s.ghost_gradient}};
}

std::vector<nlohmann::json> rows_and_mean(const nlohmann::json& result) {
  std::vector<nlohmann::json> rows = result.at("scenes");
  rows.push_back(result.at("mean"));
  return rows;
}

void print_rest(const nlohmann::json& result) {
  fmt::print("\n{:<16} {:<5} {:>6} {:>9}\n", "rest", "edges", "ring", "gradient");
  for (const nlohmann::json& row : rows_and_mean(result))
    for (const auto& [key, edges] : {std::pair{"rest", "keep"}, std::pair{"clean_rest", "clean"}})
      if (row.contains(key))
        fmt::print("{:<16} {:<5} {:>6.2f} {:>9.2f}\n", row.value("name", ""), edges,
                   row.at(key).at("ring_psnr_db").get<double>(),
                   row.at(key).at("ghost_gradient").get<double>());
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
  nlohmann::json clean_rest = rest_json(s.clean_rest);
  clean_rest.update({{"ghosts", s.ghosts}, {"given_back", s.given_back}});
  nlohmann::json json = {{"alone", alone_json(s.kept)},
                         {"clean", clean},
                         {"rest", rest_json(s.rest)},
                         {"clean_rest", clean_rest}};
  if (s.kept_ring) json["alone_ring"] = alone_json(*s.kept_ring);
  if (s.clean_ring) json["clean_ring"] = alone_json(*s.clean_ring);
  return json;
}

namespace {

void print_alone_table(const nlohmann::json& result, const char* title, const char* kept, const char* clean) {
  fmt::print("\n{:<16} {:<5} {:>6} {:>6} {:>6} {:>6} {:>7} {:>6} {:>6} {:>6} {:>6}\n", title, "edges", "IoU",
             "b 2px", "b 2%", "black", "magenta", "SSIM", "halo", "miss", "alpha");
  for (const nlohmann::json& row : rows_and_mean(result))
    for (const auto& [key, edges] : {std::pair{kept, "keep"}, std::pair{clean, "clean"}}) {
      if (!row.contains(key)) continue;
      const auto of = [&row, &key = key](const char* name) { return row.at(key).at(name).get<double>(); };
      fmt::print(
          "{:<16} {:<5} {:>6.3f} {:>6.3f} {:>6.3f} {:>6.2f} {:>7.2f} {:>6.3f} {:>6.3f} {:>6.3f} {:>6.3f}\n",
          row.value("name", ""), edges, of("iou"), of("boundary_iou_2px"), of("boundary_iou_2pct"),
          of("psnr_black_db"), of("psnr_magenta_db"), of("ssim"), of("halo"), of("missing"),
          of("alpha_error"));
    }
}

}  // namespace

void print_alone(const nlohmann::json& result) {
  print_alone_table(result, "alone", "alone", "clean");
  if (result.at("mean").contains("alone_ring"))
    print_alone_table(result, "in a ring", "alone_ring", "clean_ring");
  print_rest(result);
}

}  // namespace splatcut
