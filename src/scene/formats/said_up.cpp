#include "scene/formats/said_up.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/spoken_list.h"

namespace splatcut {

namespace {

constexpr std::string_view kUpWord = "up";
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

}  // namespace

glm::dvec3 up_from_words(std::string_view text) {
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() != 3) return glm::dvec3(kNoNumber);
  glm::dvec3 up;
  for (int c = 0; c < 3; ++c) {
    const std::string_view word = words[static_cast<std::size_t>(c)];
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), up[c]);
    if (failure != std::errc() || end != word.data() + word.size()) return glm::dvec3(kNoNumber);
  }
  return up;
}

SaidUp up_from_header(const PlyHeader& header) {
  for (const std::string& comment : header.comments)
    if (const auto words = words_of(comment); !words.empty() && words[0] == kUpWord)
      return up_from_words(std::string_view(comment).substr(kUpWord.size()));
  return {};
}

SaidUp up_from_json(const nlohmann::json& holder) {
  if (!holder.is_object() || !holder.contains("up")) return {};
  const nlohmann::json& up = holder.at("up");
  const bool numbers = up.is_array() && up.size() == 3 &&
                       std::ranges::all_of(up, [](const nlohmann::json& v) { return v.is_number(); });
  if (!numbers) return glm::dvec3(kNoNumber);
  return glm::dvec3(up[0].get<double>(), up[1].get<double>(), up[2].get<double>());
}

void take_up(const SaidUp& said, const AxisSigns& axes, Scene* scene) {
  if (!said) return;
  const double most = std::max({std::abs(said->x), std::abs(said->y), std::abs(said->z)});
  if (most > 0 && std::isfinite(said->x + said->y + said->z)) {
    scene->up = axes.position(glm::normalize(*said / most));
    return;
  }
  add_sentence("what the file says of up is no direction and is passed over", &scene->oddity);
}

glm::dvec3 up_to_say(const glm::vec3& up, const AxisSigns& axes) {
  constexpr double kSteps = 1e6;
  return glm::round(glm::dvec3(axes.position(glm::normalize(up))) * kSteps) / kSteps + 0.0;  // no -0
}

std::string words_for_up(const glm::vec3& up, const AxisSigns& axes) {
  const glm::dvec3 said = up_to_say(up, axes);
  return fmt::format("{:g} {:g} {:g}", said.x, said.y, said.z);
}

std::string up_comment(const std::optional<glm::vec3>& up) {
  return up ? fmt::format("comment {} {}\n", kUpWord, words_for_up(*up, {})) : "";
}

bool is_up_comment(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  return words.size() > 1 && words[0] == "comment" && words[1] == kUpWord;
}

void add_up(const std::optional<glm::vec3>& up, const AxisSigns& axes, nlohmann::json* holder) {
  if (!up) return;
  const glm::dvec3 said = up_to_say(*up, axes);
  (*holder)["up"] = {said.x, said.y, said.z};
}

}  // namespace splatcut
