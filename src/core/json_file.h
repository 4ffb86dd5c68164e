// JSON from files of others, and text that may not be UTF-8 as JSON. Whatever a file holds, Error is all that
// is thrown, and its sentence is about the file.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace splatcut {

// Throws Error with the byte at which it is no JSON, or nested without end. Takes at most 40 times the text.
nlohmann::json parse_json(const std::filesystem::path& path, std::string_view text);
nlohmann::json json_of_file(const std::filesystem::path& path);

// Bytes that are no UTF-8, as names of files may have, become U+FFFD. indent: -1 for one line.
std::string json_text(const nlohmann::json& json, int indent = -1);

// An index or a count. Throws json::type_error for what is no whole number from 0 to 2^53: the library would
// convert any number.
std::size_t whole_number(const nlohmann::json& value);

bool is_utf8(std::string_view text);

// What is wrong, without what the library calls it.
std::string fault_of(const nlohmann::json::exception& error);

}  // namespace splatcut
