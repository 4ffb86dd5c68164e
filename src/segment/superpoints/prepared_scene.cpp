#include "segment/superpoints/prepared_scene.h"

#include "core/error.h"
#include "core/stage_clock.h"
#include "segment/superpoints/prepared_cache.h"

namespace splatcut {

namespace {

PreparedScene made(const GaussianCloud& cloud, std::span<const Camera> observing,
                   const PrepareOptions& options, const Job& job) {
  PreparedScene prepared;
  prepared.model = options.model;
  StageClock clock(&prepared.stages);
  job.progress("parts", 0);
  clock.time("parts",
             [&] { prepared.parts = build_part_hierarchy(cloud, observing, options.model.parts, job); });
  return prepared;
}

// A cache that cannot be written is no reason not to go on.
void keep(const PreparedScene& prepared, const PreparedCache& cache, std::uint64_t key) {
  try {
    std::filesystem::create_directories(cache.folder);
    write_prepared(prepared_file(cache, key), key, prepared);
    trim_cache(cache);
  } catch (const Error&) {
  } catch (const std::filesystem::filesystem_error&) {
  }
}

}  // namespace

PreparedScene prepare_scene(const GaussianCloud& cloud, std::span<const Camera> observing,
                            const PrepareOptions& options, const Job& job) {
  if (options.cache.folder.empty()) return made(cloud, observing, options, job);
  std::vector<StageTime> stages;
  StageClock clock(&stages);
  std::uint64_t key = 0;
  auto kept = clock.time("cache", [&] {
    key = prepared_key(cloud, observing, options);
    return read_prepared(prepared_file(options.cache, key), key, cloud.size());
  });
  if (kept) {
    std::error_code ignored;  // used now: the last to be removed
    std::filesystem::last_write_time(prepared_file(options.cache, key),
                                     std::filesystem::file_time_type::clock::now(), ignored);
    kept->stages = std::move(stages);
    kept->model = options.model;
    kept->from_cache = true;
    return std::move(*kept);
  }
  PreparedScene prepared = made(cloud, observing, options, job);
  if (job.cancelled()) return prepared;
  clock.time("cache", [&] { keep(prepared, options.cache, key); });
  prepared.stages.insert(prepared.stages.end(), stages.begin(), stages.end());
  return prepared;
}

}  // namespace splatcut
