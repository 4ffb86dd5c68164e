#include "scene/formats/rad_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "core/json_file.h"
#include "scene/cloud/quantise.h"

namespace splatcut::rad {

using nlohmann::json;
namespace fs = std::filesystem;

float RadValues::at(std::size_t i, std::size_t component) const {
  const std::size_t place = component * count + i;
  const auto joined = [&](std::uint32_t n) {
    std::uint32_t bits = 0;
    for (std::uint32_t b = 0; b < n; ++b)
      bits |= static_cast<std::uint32_t>(byte(b * components + component, i)) << (8 * b);
    return bits;
  };
  switch (encoding) {
    case RadEncoding::kF32:
      return load<float>(bytes.data() + 4 * place);
    case RadEncoding::kF16:
      return half_to_float(load<std::uint16_t>(bytes.data() + 2 * place));
    case RadEncoding::kF32Bytes:
      return std::bit_cast<float>(joined(4));
    case RadEncoding::kF16Bytes:
      return half_to_float(static_cast<std::uint16_t>(joined(2)));
    case RadEncoding::kR8:
      return static_cast<float>(byte(component, i)) / 255.0f * (most - least) + least;
    case RadEncoding::kS8:
      return static_cast<float>(static_cast<std::int8_t>(byte(component, i))) / 127.0f * most;
    case RadEncoding::kLnF16:
      return std::exp(half_to_float(load<std::uint16_t>(bytes.data() + 2 * place)));
    case RadEncoding::kLn0R8: {
      const std::uint8_t step = byte(component, i);
      return step == 0 ? 0.0f : std::exp(least + static_cast<float>(step - 1) / 254.0f * (most - least));
    }
    default:
      return 0;
  }
}

std::array<float, 4> rad_rotation(const RadValues& values, std::size_t i) {
  if (values.encoding != RadEncoding::kOct) {
    const float x = values.at(i, 0), y = values.at(i, 1), z = values.at(i, 2);
    return {x, y, z, std::sqrt(std::max(0.0f, 1 - x * x - y * y - z * z))};
  }
  const auto step = [&](std::size_t c) { return std::to_integer<int>(values.bytes[3 * i + c]); };
  glm::vec3 axis(static_cast<float>(step(0)) / 255.0f * 2 - 1, static_cast<float>(step(1)) / 255.0f * 2 - 1,
                 0);
  axis.z = 1 - std::abs(axis.x) - std::abs(axis.y);
  const float below = std::max(0.0f, -axis.z);
  axis.x += axis.x >= 0 ? -below : below;
  axis.y += axis.y >= 0 ? -below : below;
  axis = glm::normalize(axis);
  constexpr float kHalfPi = 1.57079633f;
  const float half_angle = static_cast<float>(step(2)) / 255.0f * kHalfPi, s = std::sin(half_angle);
  return {axis.x * s, axis.y * s, axis.z * s, std::cos(half_angle)};
}

void refuse_rad(const fs::path& path, const std::string& what) {
  throw Error(path.string(), what, "Write it again, or give the scene that it was made of");
}

const RadEncodingName& encoding_of(const fs::path& path, const json& said, const RadFieldName& name) {
  const auto found = std::ranges::find(kRadEncodings, said.at("encoding").get<std::string>(),
                                       [](const RadEncodingName& e) { return std::string(e.name); });
  if (found == kRadEncodings.end() || std::ranges::find(name.may, found->encoding) == name.may.end())
    refuse_rad(path, fmt::format("the encoding {} of \"{}\" is not read", json_text(said.at("encoding")),
                                 name.name));
  return *found;
}

void sum_differences(std::size_t count, Bytes* bytes) {
  for (std::size_t i = 0; i < bytes->size(); ++i)
    if (i % count != 0)
      (*bytes)[i] =
          static_cast<std::byte>(std::to_integer<int>((*bytes)[i]) + std::to_integer<int>((*bytes)[i - 1]));
}

}  // namespace splatcut::rad
