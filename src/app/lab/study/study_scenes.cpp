#include "app/lab/study/study_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <span>

#include "app/console/output_folder.h"
#include "app/lab/eval_suite.h"
#include "app/measure/still_life_files.h"
#include "core/atomic_file.h"
#include "core/byte_hash.h"
#include "core/error.h"

namespace splatcut {

namespace {

constexpr const char* kPlainScene = "plain";

// The same program gives the same bytes for the same options: a folder that it made is taken as it is.
std::filesystem::path made_still_life(const StudyScenesOptions& options, const HardStillLife& hard,
                                      const Job& job) {
  const std::filesystem::path place = options.folder / fmt::format("{}, {}", hard.name, options.gaussians);
  const std::string program = fmt::format("{:016x}", hash_of_program());
  if (std::ifstream made_by(place / "program.txt"); made_by) {
    std::string word;
    if (made_by >> word && word == program) return place;
  }
  std::filesystem::create_directories(place.parent_path());
  StillLifeOptions made_of = hard.options;
  made_of.gaussians = options.gaussians;
  OutputFolder folder(place, true);
  const LabelledScene made = make_still_life(made_of);
  if (job.cancelled())
    throw Error("splatcut-lab study", "cancelled; what is finished is kept, the same command goes on");
  write_still_life(folder, made, "scene", "ply");
  write_text_file(folder.file("program.txt"), program + "\n");
  folder.commit();
  return place;
}

// Objects that show what the still life is for come first.
bool is_made_for(const HardStillLife& hard, const std::string& object) {
  const auto one_of = [&](std::initializer_list<const char*> names) {
    return std::ranges::find(names, object) != names.end();
  };
  if (hard.options.thin_width_scale < 1) return one_of({"lamp", "plant", "mug"});
  if (hard.options.twins) return one_of({"apple", "apple twin", "orange"});
  if (hard.options.occluder) return one_of({"mug"});
  if (hard.options.low_contrast) return one_of({"mug", "apple", "pot"});
  return true;
}

// Scored in a few of the circle's views, at both elevations: 24 would take longer than all that is measured.
void keep_some_views(bool quick, nlohmann::json* entry) {
  const std::size_t step = quick ? 9 : 5;
  nlohmann::json some = nlohmann::json::array();
  const nlohmann::json& all = entry->at("test_views");
  for (std::size_t v = 0; v < all.size(); v += step) some.push_back(all[v]);
  (*entry)["test_views"] = some;
}

// Of the entry and the bytes of the scene. Cameras and masks that are changed in their files are not seen.
std::string scene_key(const std::string& name, const nlohmann::json& entry,
                      const std::filesystem::path& folder) {
  Hasher hash;
  const std::string text = entry.dump();
  hash.add(std::as_bytes(std::span(text)));
  hash.number(hash_of_file(folder / entry.at("scene").get<std::string>()));
  return fmt::format("{} {:016x}", name, hash.value());
}

void add_scenes(const std::filesystem::path& suite, const HardStillLife* hard, bool main, bool quick,
                std::vector<StudyScene>* scenes) {
  std::size_t taken = 0;
  for (nlohmann::json entry : read_suite(suite)) {
    const std::string name = entry.value("name", "?");
    if (hard && !is_made_for(*hard, name)) continue;
    if (quick && taken++ == 2) break;
    if (hard) keep_some_views(quick, &entry);
    std::string called = hard ? hard->name + ", " + name : name;
    if (std::ranges::find(*scenes, called, &StudyScene::name) != scenes->end())
      called = suite.parent_path().filename().string() + ", " + name;
    scenes->push_back({entry, suite.parent_path(), called, scene_key(called, entry, suite.parent_path()),
                       main ? "" : hard->name});
  }
}

}  // namespace

const std::vector<HardStillLife>& hard_still_lifes() {
  static const std::vector<HardStillLife> all = {
      {kPlainScene, {}},
      {"twins in contact", {.twins = true, .contact = true}},
      {"straddling splats", {.straddling = true}},
      {"low contrast", {.low_contrast = true}},
      {"floaters", {.seed = 4, .floaters = true, .unseen_interior = true}},
      {"half hidden", {.occluder = true}, false},
      {"thin parts", {.thin_width_scale = 0.25f}, false},
  };
  return all;
}

std::vector<StudyScene> study_scenes(const StudyScenesOptions& options, const Job& job) {
  std::vector<StudyScene> scenes;
  for (const auto& suite : options.suites) add_scenes(suite, nullptr, true, options.quick, &scenes);
  if (options.suites.empty())
    add_scenes(made_still_life(options, hard_still_lifes().front(), job) / "suite.json",
               &hard_still_lifes().front(), true, options.quick, &scenes);
  for (const HardStillLife& hard : hard_still_lifes())
    if (std::ranges::find(options.still_lifes, hard.name) != options.still_lifes.end())
      add_scenes(made_still_life(options, hard, job) / "suite.json", &hard, false, options.quick, &scenes);
  return scenes;
}

}  // namespace splatcut
