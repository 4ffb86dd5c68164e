// Readers above the layer `scene`: what is meant, what is kept, suites.
#include <cstring>

#include "app/cli/batch_results.h"
#include "app/cli/cut_objects.h"
#include "app/cli/segmenter.h"
#include "app/cli/serve_conversation.h"
#include "app/console/camera_options.h"
#include "app/console/seeds_file.h"
#include "app/lab/eval_suite.h"
#include "app/work/work_file.h"
#include "app/work/work_history.h"
#include "core/json_file.h"
#include "fuzz.h"
#include "segment/superpoints/prepared_cache.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

// Three Gaussians, as the corpora of work and suite want them.
const Scene& small_scene() {
  static const Scene loaded = [] {
    std::string rows(3 * 32, '\x80');
    for (int row = 0; row < 3; ++row) {
      const float numbers[6] = {static_cast<float>(row), 0, 2, 0.1f, 0.1f, 0.1f};
      std::memcpy(rows.data() + 32 * row, numbers, sizeof numbers);
      rows[32 * static_cast<std::size_t>(row) + 28] = '\xff';  // of the rotation: 0x80 is zero
    }
    place().write("small.labels.u8", std::string("\0\1\1", 3));
    return load_scene(place().write("small.splat", rows));
  }();
  return loaded;
}

[[maybe_unused]] void fuzz_seeds(std::string_view bytes) {
  const nlohmann::json json = parse_json("seeds.json", bytes);
  for (const NamedSeeds& seeds : named_seeds_from_json(json, "seeds.json")) draw_seeds(seeds.strokes, 40, 30);
  draw_seeds(strokes_from_json(json, "seeds.json"), 40, 30);
}

[[maybe_unused]] void fuzz_jobs(std::string_view bytes) {
  for (const BatchJob& job : jobs_of_part(read_jobs(place().write("jobs.jsonl", bytes)), 0, 2))
    standing_result(place().folder() / job.name, job);
}

// A result that a batch left, or somebody in its place.
[[maybe_unused]] void fuzz_result(std::string_view bytes) {
  place().write(kResultFile, bytes);
  BatchJob job;
  job.asked = {{"scene", "a.ply"}};
  if (!standing_result(place().folder(), job) && listed_files(place().folder()).is_null())
    throw Error(kResultFile, "is no result");
}

[[maybe_unused]] void fuzz_request(std::string_view bytes) {
  Conversation().answer(request_from(bytes), {});
}

[[maybe_unused]] void fuzz_work(std::string_view bytes) {
  const fs::path file = place().write("a.splatcut.json", bytes);
  const WorkFile work = read_work_file(file);
  OpenedScene scene;
  scene.scene = std::shared_ptr<const Scene>(std::shared_ptr<const Scene>(), &small_scene());
  scene.files = work.files;  // however many it says: the scene's rows are what counts
  const RestoredWork read = restored(work, scene);
  History history;
  if (!read.history.steps.empty()) history.reset(read.history);
  write_work_file(place().folder() / "again.splatcut.json", scene, read.document, {}, saved_steps(history));
}

[[maybe_unused]] void fuzz_suite(std::string_view bytes) {
  small_scene();
  for (const nlohmann::json& entry : read_suite(place().write("suite.json", bytes)))
    load_case(entry, place().folder(), {}, {});
}

// The header is made right, so that what follows it is read.
[[maybe_unused]] void fuzz_cache(std::string_view bytes) {
  constexpr std::uint64_t kMagic = 0x50455250544c5053, kVersion = 2, kKey = 7;
  std::uint64_t header[5] = {kMagic, kVersion, kKey, bytes.size() - std::min<std::size_t>(bytes.size(), 8),
                             0};
  if (bytes.size() < 8) return;
  std::memcpy(&header[4], bytes.data(), 8);
  std::string file(reinterpret_cast<const char*>(header), sizeof header);
  read_prepared(place().write("a.prepared", file.append(bytes.substr(8))), kKey, 3);
}

[[maybe_unused]] void fuzz_words(std::string_view bytes) {
  const std::string text(bytes);
  const auto each = [&](const auto& read) {
    try {
      read();
    } catch (const Error&) {
    }
  };
  each([&] { make_segmenter({"text", text}); });
  each([&] { parse_click(text); });
  each([&] { parse_vec3(text, "--camera-pos"); });
}

}  // namespace

}  // namespace splatcut

SPLATCUT_FUZZ_ENTRY
