// A .ksplat of known values, for the tests: nothing here writes that format.
#pragma once

#include "scene_file_helpers.h"

namespace splatcut::testing {

// IEEE half of a number that it holds exactly.
inline std::string half_bytes(float value) {
  if (value == 0) return bytes_of(std::uint16_t{0});
  int exponent = 0;
  const float mantissa = std::frexp(std::abs(value), &exponent);  // 0.5 to 1
  const auto bits = static_cast<std::uint16_t>(
      (exponent + 14) << 10 | (static_cast<int>(mantissa * 2048) & 1023) | (value < 0 ? 0x8000 : 0));
  return bytes_of(bits);
}

// Two sections: three Gaussians of SH degree 2 in a full bucket of two and one of one, and one without SH.
// Gaussian i stands at (i + 1, -2, 0.5) and has SH coefficient number n of red, green, blue at (n - 4) / 8
// plus 0, 1/4, 1/2. Level 0, 1 or 2; SH range of level 2: -2 to 2.
inline std::string ksplat_by_hand(int level) {
  const auto number = [&](float v) { return level == 0 ? bytes_of(v) : half_bytes(v); };
  const auto sh_number = [&](float v) {
    return level == 2 ? std::string(1, static_cast<char>(std::lround((v + 2) / 4 * 255))) : number(v);
  };
  constexpr float kStep = 8.0f / 2 / 32767;  // blocks of 8
  const auto row = [&](int i, const glm::vec3& bucket, int degree) {
    const glm::vec3 p(static_cast<float>(i + 1), -2, 0.5f);
    std::string text;
    for (int c = 0; c < 3; ++c)
      text += level == 0
                  ? bytes_of(p[c])
                  : bytes_of(static_cast<std::uint16_t>(std::lround((p[c] - bucket[c]) / kStep) + 32767));
    for (const float s : {0.5f, 0.25f, 0.125f}) text += number(s);
    for (const float q : {0.0f, 0.0f, -2.0f, 0.0f}) text += number(q);  // w x y z
    text += std::string("\x00\x80\xff\x33", 4);
    const int first[] = {0, 3, 8};
    for (int d = 1; d <= degree; ++d)
      for (int c = 0; c < 3; ++c)
        for (int n = first[d - 1]; n < first[d]; ++n)
          text += sh_number(static_cast<float>(n - 4) / 8 + 0.25f * static_cast<float>(c));
    return text;
  };
  const auto section = [](std::uint32_t rows, std::uint32_t room, std::uint32_t buckets, std::uint32_t full,
                          std::uint32_t partly, std::uint16_t degree) {
    std::string text = bytes_of(rows) + bytes_of(room) + bytes_of(2u) + bytes_of(buckets) + bytes_of(8.0f) +
                       bytes_of(std::uint16_t{12}) + std::string(2, '\0') + bytes_of(32767u) + bytes_of(0u) +
                       bytes_of(full) + bytes_of(partly) + bytes_of(degree);
    text.resize(1024, '\0');
    return text;
  };
  std::string text = std::string("\x00\x01\x00\x00", 4) + bytes_of(2u) + bytes_of(2u) + bytes_of(4u) +
                     bytes_of(4u) + bytes_of(static_cast<std::uint16_t>(level)) + std::string(14, '\0') +
                     bytes_of(-2.0f) + bytes_of(2.0f);
  text.resize(4096, '\0');
  text += section(3, 4, 2, 1, 1, 2) + section(1, 1, 1, 0, 1, 0);
  const glm::vec3 here(1, 0, 0), there(5, -1, 1);
  const auto centre = [](const glm::vec3& v) { return bytes_of(v.x) + bytes_of(v.y) + bytes_of(v.z); };
  text += bytes_of(1u) + centre(here) + centre(there);
  text += row(0, here, 2) + row(1, here, 2) + row(2, there, 2);
  text.resize(text.size() + row(0, here, 2).size(), '\0');  // room for a fourth
  text += bytes_of(1u) + centre(there) + row(3, there, 0);
  return text;
}

}  // namespace splatcut::testing
