// The requests of `splatcut serve`: one table, which checks them, words their schema and says what each does.
//
// A request is a line of JSON, {"id": 7, "do": "click", "x": 512, "y": 384}. Its fields are those of its row;
// those that are options of `cut` have their names and forms there (batch_jobs.h).
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace splatcut {

// Version of the requests and replies: a new one where what is here today no longer works.
inline constexpr int kProtocol = 2;

enum class Ask {
  kOpen,
  kCamera,
  kSettings,
  kClick,
  kScribble,
  kBox,
  kSize,
  kChoice,
  kUndo,
  kClear,
  kPreview,
  kLabels,
  kExport,
  kCancel,
  kClose,
  kQuit,
  kDescribe
};

enum class FieldType { kText, kNumber, kWhole, kSwitch, kList };

struct RequestField {
  const char* name;
  FieldType type;
  bool required;
  const char* sentence;
  std::vector<std::string> values = {};  // that a text may be; empty: any
};

struct RequestKind {
  Ask ask;
  std::string name, sentence;
  std::vector<RequestField> fields = {};
  std::vector<std::string> cut_options = {};  // fields that are options of `cut`
  std::string reply = {};                     // what the reply holds beside id and ok
};

std::span<const RequestKind> request_kinds();

bool is_id(const nlohmann::json& value);  // what replies may be told apart by: text or a whole number

// Reads a line. Throws Error for what is no JSON.
nlohmann::json request_from(std::string_view line);

// Throws Error for a request that is none of the table, or whose fields are not those of its row.
const RequestKind& checked_kind(const nlohmann::json& request);

// A JSON Schema of all requests, with the sentences of the table.
nlohmann::json request_schema();

}  // namespace splatcut
