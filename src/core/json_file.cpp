#include "core/json_file.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/mapped_file.h"
#include "core/stand_in.h"

namespace splatcut {

namespace {

// A text of brackets alone would take 75 times its bytes while it is parsed.
void refuse_deep(const std::filesystem::path& path, std::string_view text) {
  constexpr int kDeepest = 4000;  // a tree of a streamed scene may go to 2000
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepest)
        throw Error(path.string(), fmt::format("is JSON nested deeper than {} at byte {}", kDeepest, i + 1));
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
}

}  // namespace

nlohmann::json parse_json(const std::filesystem::path& path, std::string_view text) {
  refuse_deep(path, text);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    refuse_stand_in(path, text);
    throw Error(path.string(), fmt::format("this is not valid JSON at byte {}", error.byte));
  } catch (const nlohmann::json::exception& error) {
    throw Error(path.string(), fmt::format("this is not valid JSON ({})", fault_of(error)));
  }
}

nlohmann::json json_of_file(const std::filesystem::path& path) {
  return parse_json(path, text_of_file(path));
}

std::string json_text(const nlohmann::json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::size_t whole_number(const nlohmann::json& value) {
  constexpr double kMost = 9007199254740992.0;  // up to it doubles are exact
  if (value.is_number()) {
    const auto number = value.get<double>();
    if (number >= 0 && number <= kMost && std::floor(number) == number)
      return static_cast<std::size_t>(number);
  }
  throw nlohmann::json::type_error::create(302, "a whole number is wanted, not " + json_text(value), &value);
}

bool is_utf8(std::string_view text) {
  try {
    return !nlohmann::json(text).dump().empty();
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

std::string fault_of(const nlohmann::json::exception& error) {
  const std::string_view said = error.what();  // "[json.exception.out_of_range.403] key 'x' not found"
  const std::size_t end = said.find("] ");
  return std::string(end == said.npos ? said : said.substr(end + 2));
}

}  // namespace splatcut
