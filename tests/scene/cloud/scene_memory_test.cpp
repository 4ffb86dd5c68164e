// What a scene takes of memory: by hand, and refused before any of it is taken.
#include "scene/cloud/scene_memory.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "core/error.h"
#include "scene/formats/scene_file.h"

using namespace splatcut;

TEST_CASE("memory: what a scene takes, what is free, and the sentence that says both") {
  CHECK(memory_of_scene(1000, 0) == 100'000);
  CHECK(memory_of_scene(1000, 3) == 280'000);  // 45 floats more each
  REQUIRE(available_memory());
  CHECK(*available_memory() > 1 << 20);
  CHECK_NOTHROW(check_memory("a.ply", 1000, 0, 100'000));
  CHECK_NOTHROW(check_memory("a.ply", 1'000'000'000'000, 3, std::nullopt));
  CHECK_THROWS_WITH_AS(
      check_memory("a.ply", 20'000'000, 0, 1'500'000'000),
      "a.ply: 20000000 Gaussians of degree 0 take 2.0 GB of memory, and 1.5 GB are free. End other "
      "programs, take a coarser level (--lod, of a streamed scene), or a file with fewer Gaussians "
      "or a lower degree of spherical harmonics.",
      Error);
}

TEST_CASE("memory: a file of more Gaussians than the machine holds is refused before it is read") {
  constexpr std::uint64_t kRowBytes = 32, kRows = 4'000'000'000;
  if (*available_memory() >= memory_of_scene(kRows, 0)) return;  // a machine that does hold them
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("splatcut_memory_test_" + std::to_string(::getpid()) + ".splat");
  const struct Removed {
    const std::filesystem::path& path;
    ~Removed() { std::filesystem::remove(path); }
  } removed{file};
  { std::ofstream(file) << ""; }
  std::error_code failure;
  std::filesystem::resize_file(file, kRows * kRowBytes, failure);  // holes: no disk is taken
  if (failure) return;                                             // a file system without them
  std::string said;
  try {
    load_scene(file);
  } catch (const Error& error) {
    said = error.what();
  }
  CHECK(said.find("4000000000 Gaussians of degree 0 take 400.0 GB of memory") != std::string::npos);
}
