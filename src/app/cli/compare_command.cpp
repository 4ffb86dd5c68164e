// splatcut compare: two pictures, as a test.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <optional>
#include <utility>

#include "app/cli/commands.h"
#include "app/console/kept_inputs.h"
#include "app/console/output_folder.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/picture_difference.h"
#include "core/picture_file.h"
#include "core/png_file.h"

namespace splatcut {

namespace {

struct CompareArguments {
  std::filesystem::path a, b, diff;
  std::optional<int> max_diff;
  std::optional<double> pixels_percent, psnr_db, ssim;
  bool json = false, overwrite = false;
};

// What the pictures miss; empty where they are alike enough.
std::string shortfall(const CompareArguments& args, const PictureDifference& d) {
  if (args.psnr_db && d.psnr_db < *args.psnr_db)
    return fmt::format("PSNR {:.2f} dB is below {:.2f} dB", d.psnr_db, *args.psnr_db);
  if (args.ssim && d.ssim < *args.ssim) return fmt::format("SSIM {:.5f} is below {:.5f}", d.ssim, *args.ssim);
  const bool by_levels = args.max_diff || args.pixels_percent || (!args.psnr_db && !args.ssim);
  const double allowed = args.pixels_percent.value_or(0);
  if (by_levels && 100 * d.share_beyond > allowed)
    return fmt::format("{:.4f} % of the pixels differ by more than {}; {} % are allowed",
                       100 * d.share_beyond, args.max_diff.value_or(0), allowed);
  return {};
}

struct Compared {
  PictureDifference difference;
  Image<Rgb8> picture;  // of it, where one is to be written
};

template <class Pixel>
Compared compared(const CompareArguments& args, const Image<Pixel>& a, const Image<Pixel>& b) {
  Compared both{picture_difference(a, b, args.max_diff.value_or(0)), {}};
  if (!args.diff.empty()) both.picture = difference_picture(a, b);
  return both;
}

// In 8 bits where neither picture holds more.
Compared compared(const CompareArguments& args) {
  ExactPng a = read_exact_png(args.a), b = read_exact_png(args.b);
  if (a.rgba16.empty() && b.rgba16.empty()) return compared(args, a.rgb8, b.rgb8);
  for (ExactPng* one : {&a, &b})
    if (one->rgba16.empty()) one->rgba16 = rgba16_of(std::exchange(one->rgb8, {}));
  return compared(args, a.rgba16, b.rgba16);
}

void run_compare(const CompareArguments& args, const CommonOptions& common) {
  if (!args.diff.empty()) {
    refuse_name_of_png(args.diff);
    refuse_written_inputs(args.diff, {args.a, args.b});
    check_output_file(args.diff, args.overwrite);
  }
  const auto [d, picture] = compared(args);
  if (!args.diff.empty()) write_png(args.diff, picture);
  const std::string missed = shortfall(args, d);
  if (args.json) {
    nlohmann::json out = {{"largest", d.largest},
                          {"pixels_percent", 100 * d.share_beyond},
                          {"ssim", d.ssim},
                          {"alike", missed.empty()}};
    out["psnr_db"] = d.largest == 0 ? nlohmann::json("inf") : nlohmann::json(d.psnr_db);
    fmt::print("{}\n", json_text(out, 2));
  } else if (!common.quiet) {
    fmt::print("largest {}  pixels {:.4f} %  PSNR {:.2f} dB  SSIM {:.5f}\n", d.largest, 100 * d.share_beyond,
               d.psnr_db, d.ssim);
  }
  if (!missed.empty()) throw Error(args.b.string(), "differs from " + args.a.string() + ": " + missed);
}

}  // namespace

void add_compare_command(CLI::App& program, const CommonOptions& common) {
  auto args = std::make_shared<CompareArguments>();
  CLI::App& command =
      *program.add_subcommand("compare", "Compare two pictures; exit code 1 where they differ too much");
  command.footer(
      "Example: splatcut compare expected.png shot.png --max-diff 5 --pixels 0.1 --diff "
      "difference.png\nWithout a limit every pixel must be equal.");
  command.add_option("a", args->a, "PNG")->required();
  command.add_option("b", args->b, "PNG")->required();
  command.add_option("--max-diff", args->max_diff, "Levels of 255 that a channel, or alpha, may differ by")
      ->check(CLI::Range(0, 255));
  command.add_option("--pixels", args->pixels_percent, "Percent of the pixels that may differ by more")
      ->check(within(0, 100));
  command.add_option("--psnr", args->psnr_db, "Least PSNR, dB")->check(within(0, 1000));
  command.add_option("--ssim", args->ssim, "Least SSIM")->check(within(-1, 1));
  command.add_option("--diff", args->diff, "Writes eight times the difference as PNG");
  command.add_flag("--json", args->json, "Print JSON");
  command.add_flag("--overwrite", args->overwrite, "Replace an existing --diff file");
  command.callback([args, &common] { run_compare(*args, common); });
}

}  // namespace splatcut
