// Reader of .sog (PlayCanvas), versions 1 and 2, as one file or as a folder.
#include "scene/formats/sog.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "core/error.h"
#include "core/json_file.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/decode.h"
#include "scene/formats/said_up.h"
#include "scene/formats/sog_rows.h"
#include "scene/packing/incomplete.h"
#include "scene/packing/webp.h"
#include "scene/packing/zip_file.h"

namespace splatcut {

namespace {

using nlohmann::json;

constexpr std::string_view kZipMark = "PK\x03\x04";
constexpr const char* kMetaName = "meta.json";

// The files of a scene, from an archive or a folder.
class SogFiles {
 public:
  explicit SogFiles(const MappedFile& file) : file_(file) {
    if (!begins_with(file, kZipMark)) return;
    zip_.emplace(file);
    const std::string meta = zip_->find(kMetaName);
    if (meta.empty())
      throw Error(file.path().string(), "is a ZIP without meta.json, not a scene (.sog)",
                  "Unpack it and give the scene inside");
    prefix_ = meta.substr(0, meta.size() - std::string_view(kMetaName).size());
  }
  json meta() const {
    const std::vector<std::byte> packed = zip_ ? zip_->read(prefix_ + kMetaName) : std::vector<std::byte>();
    const std::span<const std::byte> bytes = zip_ ? std::span<const std::byte>(packed) : file_.bytes();
    return parse_json(zip_ ? file_.path() / kMetaName : file_.path(),
                      {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  // Adds the file that it lies in to `packed`.
  Image<Rgba8> picture(const std::string& name,
                       std::map<std::filesystem::path, std::uint64_t>* packed) const {
    packed->emplace(file_.path(), file_.bytes().size());
    if (zip_) return read_webp(file_.path(), name, zip_->read(prefix_ + name), file_.bytes().size());
    if (std::filesystem::path(name).filename() != name)
      throw Error(file_.path().string(), fmt::format("names the picture \"{}\" in another folder", name));
    const MappedFile picture(file_.path().parent_path() / name);
    packed->emplace(picture.path(), picture.bytes().size());
    return read_webp(picture.path(), name, picture.bytes(), picture.bytes().size() + file_.bytes().size());
  }

 private:
  const MappedFile& file_;
  std::optional<ZipReader> zip_;
  std::string prefix_;
};

using Tables = SogRows::Tables;

Tables tables_of_codebook(const json& codebook) {
  Tables tables{};
  const std::size_t count = std::min<std::size_t>(256, codebook.size());
  // Older writers put null for the least value; as PlayCanvas' engine does, it is taken to lie one mean step
  // below the next.
  const bool lacks_least = count > 2 && codebook.at(0).is_null();
  for (auto& table : tables) {
    for (std::size_t i = lacks_least; i < count; ++i) table[i] = codebook.at(i).get<float>();
    if (lacks_least) table[0] = table[1] - (table[count - 1] - table[1]) / static_cast<float>(count - 1);
  }
  return tables;
}
Tables tables_of_ranges(const json& mins, const json& maxs) {
  Tables tables{};
  for (std::size_t c = 0; c < 4; ++c) {
    const std::size_t at = std::min(c, mins.is_array() ? mins.size() - 1 : 0);
    const float least = (mins.is_array() ? mins.at(at) : mins).get<float>(),
                most = (maxs.is_array() ? maxs.at(at) : maxs).get<float>();
    for (std::size_t i = 0; i < 256; ++i)
      tables[c][i] = least + (most - least) * static_cast<float>(i) / 255.0f;
  }
  return tables;
}
Tables tables_of(const json& part) {
  return part.contains("codebook") ? tables_of_codebook(part.at("codebook"))
                                   : tables_of_ranges(part.at("mins"), part.at("maxs"));
}

float byte(const Image<Rgba8>& image, std::size_t row, std::size_t channel) {
  return static_cast<float>(image.pixels()[row][channel]);
}

glm::vec3 scale_of(const SogRows& rows, std::size_t row) {
  const Rgba8& p = rows.scales.pixels()[row];
  const Tables& t = rows.scale_tables;
  return glm::exp(glm::vec3(t[0][p[0]], t[1][p[1]], t[2][p[2]]));
}

glm::vec3 f_dc_of(const SogRows& rows, std::size_t row) {
  const Rgba8& p = rows.sh0.pixels()[row];
  const Tables& t = rows.sh0_tables;
  return {t[0][p[0]], t[1][p[1]], t[2][p[2]]};
}

std::size_t label_of(const SogRows& rows, std::size_t row) {
  const Rgba8& p = rows.labels.pixels()[row];
  return p[0] | static_cast<std::size_t>(p[1]) << 8;
}

glm::quat rotation_of(const SogRows& rows, std::size_t row) {
  const Rgba8& p = rows.quats.pixels()[row];
  const auto largest = static_cast<std::size_t>(p[3] - sog::kLargestAt);
  std::array<float, 4> q{};
  float sum = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == largest) continue;
    q[i] = (static_cast<float>(p[next++]) / 255.0f * 2 - 1) / std::sqrt(2.0f);
    sum += q[i] * q[i];
  }
  q[largest] = std::sqrt(std::max(0.0f, 1 - sum));
  return glm::normalize(glm::quat(q[0], q[1], q[2], q[3]));
}

glm::vec3 vec3_of(const json& list) {
  return {list.at(0).get<float>(), list.at(1).get<float>(), list.at(2).get<float>()};
}

// The degree whose coefficients, 64 times, make the picture's width; 0 for none.
int degree_of_width(int width) {
  for (int degree = 1; degree <= 3; ++degree)
    if (width == static_cast<int>(sog::kCentroidsPerRow) * sh_rest_coefficients(degree)) return degree;
  return 0;
}

void read_pictures(const MappedFile& file, const SogFiles& files, const json& meta, SogRows* rows,
                   const Job& job) {
  struct Wanted {
    const char* part;
    std::size_t index;
    Image<Rgba8>* image;
    bool each_gaussian;  // a pixel
  };
  std::vector<Wanted> all = {{"means", 0, &rows->low, true},
                             {"means", 1, &rows->high, true},
                             {"quats", 0, &rows->quats, true},
                             {"scales", 0, &rows->scales, true},
                             {"sh0", 0, &rows->sh0, true}};
  if (meta.contains("shN")) {
    all.push_back({"shN", 0, &rows->centroids, false});
    all.push_back({"shN", 1, &rows->labels, true});
  }
  for (const Wanted& wanted : all) {
    if (job.cancelled()) return;
    const auto name = meta.at(wanted.part).at("files").at(wanted.index).get<std::string>();
    *wanted.image = files.picture(name, &rows->packed);
    check_expansion(file.path(), rows->packed_bytes(), rows->unpacked_bytes());
    if (wanted.each_gaussian && wanted.image->size() < rows->count)
      throw Error(file.path().string(),
                  incomplete(fmt::format("the picture {} has {} pixels for {} Gaussians", name,
                                         wanted.image->size(), rows->count)));
  }
}

std::size_t count_of(const MappedFile& file, const json& meta) {
  const int version = meta.value("version", 1);
  if (version != 1 && version != 2)
    throw Error(file.path().string(), fmt::format("version {} of .sog is not supported", version));
  const auto count = whole_number(version == 1 ? meta.at("means").at("shape").at(0) : meta.at("count"));
  if (count == 0 || count > std::numeric_limits<std::uint32_t>::max())
    throw Error(file.path().string(), fmt::format("promises {} Gaussians", count));
  return count;
}

// Incomplete when cancelled.
SogRows rows_of(const MappedFile& file, const Job& job) {
  const SogFiles files(file);
  const json meta = files.meta();
  SogRows rows;
  rows.count = count_of(file, meta);
  rows.antialiased = meta.value("antialias", false) || meta.value("model", "") == "antialiased";
  rows.up = up_from_json(meta);
  rows.logits = meta.value("version", 1) == 1;
  rows.least = vec3_of(meta.at("means").at("mins"));
  rows.most = vec3_of(meta.at("means").at("maxs"));
  rows.scale_tables = tables_of(meta.at("scales"));
  rows.sh0_tables = tables_of(meta.at("sh0"));
  read_pictures(file, files, meta, &rows, job);
  if (!meta.contains("shN") || job.cancelled()) return rows;
  rows.sh_tables = tables_of(meta.at("shN"));
  for (const auto& table : rows.sh_tables)
    if (!std::ranges::all_of(table, [](float v) { return std::isfinite(v); }))
      throw Error(file.path().string(), "a number of its spherical harmonics is beyond all bounds");
  rows.degree = degree_of_width(rows.centroids.width());
  if (rows.degree == 0)
    throw Error(file.path().string(),
                fmt::format("its spherical harmonics are {} pixels wide; 192, 512 or 960 are "
                            "possible",
                            rows.centroids.width()));
  rows.palette = static_cast<std::size_t>(rows.centroids.height()) * sog::kCentroidsPerRow;
  return rows;
}

template <class Read>
auto of_sog(const MappedFile& file, const Read& read) {
  try {
    return read();
  } catch (const json::exception& error) {
    throw Error(file.path().string(),
                fmt::format("its meta.json is not that of a .sog ({})", fault_of(error)));
  }
}

void read_sog(const MappedFile& file, const LoadOptions&, Scene& scene, const Job& job) {
  job.progress("unpacking pictures", 0.0);
  const SogRows rows = read_sog_rows(file, job);
  scene.cloud.antialiased = rows.antialiased;
  for (const auto& [path, bytes] : rows.packed) scene.files.push_back(path);
  if (!job.cancelled()) decode_rows(rows, rows.count, rows.degree, scene, job);
  take_up(rows.up, {}, &scene);
}

bool is_sog(const MappedFile& file) {
  if (begins_with(file, kZipMark)) return true;
  const std::string_view text = file.text();
  return begins_as_json(file) && text.find("\"means\"") != text.npos && text.find("\"quats\"") != text.npos;
}

}  // namespace

glm::vec3 SogRows::position(std::size_t row) const {
  const bool good = quats.pixels()[row][3] >= sog::kLargestAt && is_within_reach(scale_of(*this, row)) &&
                    is_finite(f_dc_of(*this, row)) && (degree == 0 || label_of(*this, row) < palette);
  if (!good) return kDroppedRow;
  glm::vec3 p;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const float fraction = (byte(low, row, channel) + 256.0f * byte(high, row, channel)) / sog::kSteps;
    p[c] = sog::from_log(least[c] + (most[c] - least[c]) * fraction);
  }
  return p;
}

void SogRows::decode(std::size_t row, GaussianCloud& cloud, std::size_t g) const {
  const std::uint8_t opacity = sh0.pixels()[row][3];
  cloud.scale[g] = scale_of(*this, row);
  cloud.rotation[g] = rotation_of(*this, row);
  cloud.f_dc[g] = f_dc_of(*this, row);
  cloud.opacity[g] = logits ? sigmoid(sh0_tables[3][opacity]) : static_cast<float>(opacity) / 255.0f;
  if (degree == 0) return;
  const auto own = static_cast<std::size_t>(sh_rest_coefficients(degree));
  const std::size_t all = cloud.sh_stride() / 3, entry = label_of(*this, row);
  const Rgba8* centroid =
      &centroids.row(static_cast<int>(entry / sog::kCentroidsPerRow))[entry % sog::kCentroidsPerRow * own];
  float* rest = cloud.sh_rest.data() + g * cloud.sh_stride();
  for (std::size_t k = 0; k < own; ++k)
    for (std::size_t c = 0; c < 3; ++c) rest[c * all + k] = sh_tables[c][centroid[k][c]];
}

std::uint64_t SogRows::packed_bytes() const {
  std::uint64_t bytes = 0;
  for (const auto& [path, file_bytes] : packed) bytes += file_bytes;
  return bytes;
}

std::uint64_t SogRows::unpacked_bytes() const {
  std::uint64_t pixels = 0;
  for (const Image<Rgba8>* picture : {&low, &high, &quats, &scales, &sh0, &centroids, &labels})
    pixels += picture->size();
  return pixels * sizeof(Rgba8);
}

SogRows read_sog_rows(const MappedFile& file, const Job& job) {
  return of_sog(file, [&] { return rows_of(file, job); });
}

int degree_of_sog(const MappedFile& file) {
  return of_sog(file, [&] {
    const json meta = SogFiles(file).meta();
    return meta.contains("shN") ? std::clamp(meta.at("shN").value("bands", 3), 1, 3) : 0;
  });
}

constinit const SceneFormat SceneFormat::kSog = {
    .name = "sog",
    .extension = ".sog",
    .also = "meta.json",
    .recognises = is_sog,
    .read = read_sog,
    .write = write_sog,
    .plan = plan_sog,
};

}  // namespace splatcut
