#include "core/json_file.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/mapped_file.h"

namespace splatcut {

nlohmann::json parse_json(const std::filesystem::path& path, std::string_view text) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    throw Error(path.string(), fmt::format("is not valid JSON at byte {}", error.byte));
  } catch (const nlohmann::json::exception& error) {
    throw Error(path.string(), fmt::format("is not valid JSON ({})", fault_of(error)));
  }
}

nlohmann::json json_of_file(const std::filesystem::path& path) {
  return parse_json(path, text_of_file(path));
}

std::string json_text(const nlohmann::json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
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
