// A .ply whose last rows are those of others with another place, size, turn and opacity.
#include <cmath>
#include <cstring>

#include "quick.h"
#include "scene_file_helpers.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

constexpr std::size_t kRowBytes = 1 + 3 * 8 + 12 * 4;
const std::vector<std::string> kFloats = {"opacity", "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",
                                          "rot_2",   "rot_3",   "f_dc_0",  "f_dc_1",  "f_dc_2", "filter_3D"};

// Two rows, with a column of no Gaussian, positions in double, and the 3D filter of Mip-Splatting.
std::string odd_ply() {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty uchar tag\nproperty double x\n"
      "property double y\nproperty double z\n";
  for (const std::string& name : kFloats) text += "property float " + name + "\n";
  text += "end_header\n";
  for (int row = 0; row < 2; ++row) {
    text += static_cast<char>(40 + row);
    for (const double v : {1.0 + row, 2.0, 3.0}) text += bytes_of(v);
    for (const float v : {0.0f, -2.0f, -3.0f, -4.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.1f, 0.2f, 0.3f, 0.5f})
      text += bytes_of(v);
  }
  return text;
}

template <class T>
T value_at(const std::string& text, std::size_t at) {
  T value;
  std::memcpy(&value, text.data() + at, sizeof value);
  return value;
}

}  // namespace

QUICK_CASE("ply", "ply: changed rows keep all but place, size, turn and opacity of the row that they were") {
  const Folder folder;
  const std::string text = odd_ply();
  write(folder / "odd.ply", text);
  const Scene scene = load_scene(folder / "odd.ply");
  REQUIRE(scene.rows_can_be_changed);
  GaussianCloud changed =
      permuted(scene.cloud, std::vector<std::uint32_t>{scene.cloud.file_row[0] == 1 ? 0u : 1u});
  changed.position[0] = {7, 8, 9};
  changed.scale[0] = {0.5f, 0.25f, 0.125f};
  changed.rotation[0] = {0, 0, 1, 0};
  changed.opacity[0] = 0.75f;
  const SaveReport saved =
      save_scene(folder / "more.ply", scene, {}, SceneFormat::kPly, {.changed_rows = &changed});
  CHECK(saved.gaussians == 3);
  const std::string more = text_of(folder / "more.ply");
  const std::size_t header = more.find("end_header\n") + 11;
  REQUIRE(more.size() == header + 3 * kRowBytes);
  CHECK(more.substr(header, 2 * kRowBytes) == text.substr(text.size() - 2 * kRowBytes));
  const std::size_t row = header + 2 * kRowBytes;
  CHECK(more[row] == 41);  // the tag of the second row
  CHECK(value_at<double>(more, row + 1) == 7);
  CHECK(value_at<double>(more, row + 17) == 9);
  const auto of = [&](std::size_t field) { return value_at<float>(more, row + 25 + 4 * field); };
  CHECK(of(0) == doctest::Approx(std::log(3.0)));  // logit of .75
  CHECK(of(1) == doctest::Approx(std::log(0.5)));
  CHECK(of(3) == doctest::Approx(std::log(0.125)));
  CHECK(of(6) == 1);
  CHECK(of(9) == 0.2f);  // the colour stays
  CHECK(of(11) == 0);    // the filter is in the size already
  const GaussianCloud back = load_scene(folder / "more.ply").cloud;
  REQUIRE(back.size() == 3);
  for (std::size_t g = 0; g < 3; ++g)
    if (back.file_row[g] == 2) CHECK(back.opacity[g] == doctest::Approx(0.75));
}

QUICK_CASE("ply", "ply: rows without a third size cannot be changed") {
  const Folder folder;
  std::string flat = odd_ply();
  flat.replace(flat.find("scale_2"), 7, "other_2");
  write(folder / "flat.ply", flat);
  CHECK_FALSE(load_scene(folder / "flat.ply").rows_can_be_changed);
}
