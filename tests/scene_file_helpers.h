// Files made by hand and what they are compared with, for the tests of the scene formats.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "scene/formats/scene_file.h"

namespace splatcut::testing {

namespace fs = std::filesystem;

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Folder {
  fs::path path = fs::temp_directory_path() / ("splatcut_scene_file_test_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  fs::path operator/(const std::string& name) const { return path / name; }
};

// Formats that are written and read.
inline std::vector<SceneFormat> both_ways() {
  std::vector<SceneFormat> formats = written_formats();
  std::erase_if(formats, [](const SceneFormat& format) { return !format.read; });
  return formats;
}

// Every value, bit for bit.
inline void check_equal(const GaussianCloud& a, const GaussianCloud& b) {
  CHECK(a.position == b.position);
  CHECK(a.scale == b.scale);
  CHECK(a.rotation == b.rotation);
  CHECK(a.opacity == b.opacity);
  CHECK(a.f_dc == b.f_dc);
  CHECK(a.sh_degree == b.sh_degree);
  CHECK(a.sh_rest == b.sh_rest);
  CHECK(a.file_row == b.file_row);
}

inline std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}
inline void write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

template <class T>
inline std::string bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

inline std::vector<std::string> splat_names(int rest) {
  std::vector<std::string> names{"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"};
  for (int i = 0; i < rest; ++i) names.push_back("f_rest_" + std::to_string(i));
  for (const char* name : {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    names.push_back(name);
  return names;
}

inline std::string header(const std::vector<std::string>& names, std::size_t count) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment made by hand\nelement vertex " +
                     std::to_string(count) + "\n";
  for (const std::string& name : names) text += "property float " + name + "\n";
  return text + "end_header\n";
}

// Rows whose every value says which row and field it is.
inline std::string numbered_ply(const std::vector<std::string>& names, int count) {
  std::string text = header(names, static_cast<std::size_t>(count));
  for (int row = 0; row < count; ++row) {
    for (std::size_t f = 0; f < names.size(); ++f) {
      float value = 0.001f * static_cast<float>(f) + 0.01f * static_cast<float>(row);
      if (names[f] == "x") value = static_cast<float>((row * 7919) % count);
      text += bytes_of(value);
    }
  }
  return text;
}

inline GaussianCloud varied_cloud(std::size_t n, int degree) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  GaussianCloud cloud;
  cloud.resize(n, degree);
  for (std::size_t g = 0; g < n; ++g) {
    cloud.position[g] = {5 * unit(random), 5 * unit(random), 5 * unit(random)};
    cloud.scale[g] = glm::exp(glm::vec3(unit(random), unit(random), unit(random)) - 4.0f);
    cloud.rotation[g] = glm::normalize(glm::quat(unit(random), unit(random), unit(random), unit(random)));
    cloud.opacity[g] = 0.5f + 0.49f * unit(random);
    cloud.f_dc[g] = {unit(random), unit(random), unit(random)};
    cloud.file_row[g] = static_cast<std::uint32_t>(g);
  }
  for (float& v : cloud.sh_rest) v = 0.9f * unit(random);
  return cloud;
}

struct Tolerance {
  float position, log_scale, rotation, opacity, f_dc, sh;
};

inline void check_same(const GaussianCloud& expected, const Scene& got, const Tolerance& limit) {
  REQUIRE(got.cloud.size() == expected.size());
  Tolerance worst{};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::uint32_t row = got.cloud.file_row[i];
    const auto largest = [](const glm::vec3& v) {
      return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    };
    worst.position = std::max(worst.position, largest(got.cloud.position[i] - expected.position[row]));
    worst.log_scale = std::max(worst.log_scale, largest(glm::log(got.cloud.scale[i] / expected.scale[row])));
    worst.rotation =
        std::max(worst.rotation, 1 - std::abs(glm::dot(got.cloud.rotation[i], expected.rotation[row])));
    worst.opacity = std::max(worst.opacity, std::abs(got.cloud.opacity[i] - expected.opacity[row]));
    worst.f_dc = std::max(worst.f_dc, largest(got.cloud.f_dc[i] - expected.f_dc[row]));
    if (got.cloud.sh_degree != expected.sh_degree) continue;
    for (std::size_t k = 0; k < expected.sh_stride(); ++k)
      worst.sh = std::max(worst.sh, std::abs(got.cloud.sh_rest_of(i)[k] - expected.sh_rest_of(row)[k]));
  }
  CHECK(worst.position <= limit.position);
  CHECK(worst.log_scale <= limit.log_scale);
  CHECK(worst.rotation <= limit.rotation);
  CHECK(worst.opacity <= limit.opacity);
  CHECK(worst.f_dc <= limit.f_dc);
  CHECK(worst.sh <= limit.sh);
}

// The message of the Error that loading the file throws.
inline std::string refusal(const fs::path& path) {
  try {
    load_scene(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}
inline bool mentions(const std::string& text, std::initializer_list<const char*> parts) {
  for (const char* part : parts) {
    if (text.find(part) != text.npos) continue;
    MESSAGE(text, " lacks ", std::string(part));
    return false;
  }
  return true;
}

inline std::string gunzip(const std::string& data) {
  z_stream stream{};
  inflateInit2(&stream, 16 + MAX_WBITS);
  std::string out(std::max<std::size_t>(1 << 20, 30 * data.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<uInt>(data.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  inflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

inline std::string zstd(const std::string& data) {
  std::string out(ZSTD_compressBound(data.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), data.data(), data.size(), 3));
  return out;
}

inline std::string gzip(const std::string& data) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string out(data.size() + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = static_cast<uInt>(data.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

}  // namespace splatcut::testing
