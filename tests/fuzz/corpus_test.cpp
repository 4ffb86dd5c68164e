// Every reader of files of others, fed with its fuzzer's corpus: what it holds is read, and what it holds cut
// short or with a byte changed is read or refused with an Error. That nothing is read beyond its end, the
// sanitizers see.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

#include "fuzz/app_fuzz.cpp"
#include "fuzz/scene_fuzz.cpp"
#include "places.h"
#include "quick.h"

using namespace splatcut;

namespace {

using Reader = void (*)(std::string_view bytes);

std::vector<std::string> corpus_of(const std::string& reader) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(testing::project_folder() + "/tests/fuzz/corpus/" + reader))
    paths.push_back(entry.path());
  std::ranges::sort(paths);
  std::vector<std::string> files;
  for (const fs::path& path : paths) {
    std::ifstream in(path, std::ios::binary);
    files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return files;
}

// Evenly over the file, each of the changes that readers fear: a bit, nothing, the most.
constexpr std::size_t kPlaces = 40;

// refuses: by an Error, as all but the cache do, which is no file of others.
void check_reader(const std::string& name, Reader read, bool refuses = true) {
  const std::vector<std::string> files = corpus_of(name);
  REQUIRE_FALSE(files.empty());
  int refused = 0;
  const auto try_reading = [&](const std::string& bytes) {
    try {
      read(bytes);
    } catch (const Error& error) {
      CHECK(std::string_view(error.what()).size() > 10);
      ++refused;
    }
  };
  for (const std::string& file : files) {
    CHECK_NOTHROW(read(file));
    for (std::size_t i = 0; i < kPlaces; ++i) {
      const std::size_t at = i * file.size() / kPlaces;
      try_reading(file.substr(0, at));
      for (const char byte : {static_cast<char>(file[at] ^ 0x10), '\0', '\xff'}) {
        std::string changed = file;
        changed[at] = byte;
        try_reading(changed);
      }
    }
  }
  CHECK((refused > 0) == refuses);
}

}  // namespace

QUICK_CASE("ply", "corpus: .ply") {
  check_reader("ply", fuzz_ply);
}
QUICK_CASE("splat", "corpus: .splat") {
  check_reader("splat", fuzz_splat);
}
QUICK_CASE("spz", "corpus: .spz") {
  check_reader("spz", fuzz_spz);
}
QUICK_CASE("sog", "corpus: .sog") {
  check_reader("sog", fuzz_sog);
}
QUICK_CASE("sog", "corpus: the text of a .sog") {
  check_reader("sog_text", fuzz_sog_text);
}
QUICK_CASE("streamed sog", "corpus: the index of a streamed .sog") {
  check_reader("streamed_sog_text", fuzz_streamed_sog_text);
}
QUICK_CASE("glb", "corpus: .glb") {
  check_reader("glb", fuzz_glb);
}
QUICK_CASE("glb", "corpus: .gltf") {
  check_reader("gltf", fuzz_gltf);
}
QUICK_CASE("lcc", "corpus: .lcc") {
  check_reader("lcc", fuzz_lcc);
}
QUICK_CASE("lcc2", "corpus: .lcc2") {
  check_reader("lcc2", fuzz_lcc2);
}

QUICK_CASE("rad", "corpus: .rad") {
  check_reader("rad", fuzz_rad);
}

QUICK_CASE("ksplat", "corpus: .ksplat") {
  check_reader("ksplat", fuzz_ksplat);
}
QUICK_CASE("JSON", "corpus: cameras in JSON") {
  check_reader("json_cameras", fuzz_json_cameras);
}
QUICK_CASE("COLMAP", "corpus: COLMAP's cameras, binary") {
  check_reader("colmap_bin", fuzz_colmap_bin);
}
QUICK_CASE("COLMAP", "corpus: COLMAP's cameras, text") {
  check_reader("colmap_txt", fuzz_colmap_txt);
}
QUICK_CASE("PNG", "corpus: .png") {
  check_reader("png", fuzz_png);
}
QUICK_CASE("seeds", "corpus: seeds") {
  check_reader("seeds", fuzz_seeds);
}
QUICK_CASE("jobs", "corpus: lists of jobs") {
  check_reader("jobs", fuzz_jobs);
}
QUICK_CASE("jobs", "corpus: results of jobs") {
  check_reader("result", fuzz_result);
}
QUICK_CASE("requests", "corpus: requests to serve") {
  check_reader("request", fuzz_request);
}
QUICK_CASE("suite", "corpus: suites") {
  check_reader("suite", fuzz_suite);
}
QUICK_CASE("work file", "corpus: work files") {
  check_reader("work", fuzz_work);
}
QUICK_CASE("prepared cache", "corpus: the cache of prepared scenes") {
  check_reader("cache", fuzz_cache, false);
}
QUICK_CASE("command line", "corpus: words of the command line") {
  for (const std::string& text : corpus_of("words")) CHECK_NOTHROW(fuzz_words(text));
}
