#include "app/cli/cutout_object.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "app/cli/cutout_files.h"

namespace splatcut {

void EdgeOptions::add_to(CLI::App& command) {
  command
      .add_option("--edges", edges,
                  "clean: the object without what the scene around it had hidden, where its views agree; "
                  "keep: its rows as they are")
      ->check(CLI::IsMember({"clean", "keep"}))
      ->capture_default_str();
}

CutoutObject::CutoutObject(const Scene& scene, const std::vector<std::uint8_t>& labels,
                           const EdgeOptions& options, const Surroundings& around, const Job& job)
    : scene_(scene), drawer_(scene.cloud, nullptr, &around.blocks), labels_(labels) {
  if (!options.clean()) return;
  const auto start = std::chrono::steady_clock::now();
  clean_ = clean_object({drawer_, labels, around.up_world, around.cameras}, {}, job);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  ms_ = took.count();
}

void CutoutObject::save(const std::filesystem::path& path) const {
  if (is_clean())
    save_scene(path, with_cloud(scene_, clean_->cloud), {}, SceneFormat::kPly);
  else
    save_scene(path, scene_, labels_, SceneFormat::kPly);
}

void CutoutObject::draw(const std::filesystem::path& path, const Camera& camera) const {
  if (is_clean())
    write_cutout_picture(path, clean_->cloud, camera, {});
  else
    write_cutout_picture(path, drawer_, camera, labels_);
}

std::size_t CutoutObject::gaussians() const {
  return is_clean() ? clean_->cloud.size() : static_cast<std::size_t>(std::ranges::count(labels_, 1));
}

nlohmann::json CutoutObject::report() const {
  nlohmann::json json = {{"edges", is_clean() ? "clean" : "keep"}, {"gaussians", gaussians()}};
  if (!clean_) return json;
  const CleanReport& report = clean_->report;
  json.update({{"views", report.views}, {"agreed", report.agreed}, {"ms", ms_}});
  if (!report.cleaned) {
    json["why_kept"] = report.reason;
    return json;
  }
  if (report.uncut) json["uncut"] = true;
  json.update({{"left", report.left},
               {"split", report.split},
               {"made_solid", report.made_solid},
               {"recoloured", report.recoloured}});
  return json;
}

}  // namespace splatcut
