#include "app/cli/serve_requests.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "app/cli/cut_run.h"
#include "app/placing/export_placement.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/spoken_list.h"

namespace splatcut {

namespace {

using enum FieldType;

const RequestField kPath{"path", kText, false,
                         "File to write; without it the reply holds the bytes as base64"};
const RequestField kReplaces{"overwrite", kSwitch, false, "A file of that name is replaced"};
const RequestField kLabel{
    "label", kText, false, "Whether it marks the object (default) or the rest", {"object", "rest"}};
constexpr const char* kObjectReply =
    "gaussians of the object; choice, choices and certainty of the first click; size and sizes of the last "
    "one; doubts, "
    "sentences";

const std::vector<RequestKind>& kinds() {
  static const std::vector<RequestKind> table = {
      {Ask::kOpen,
       "open",
       "Opens a scene in place of the one that is open",
       {{"scene", kText, true, "Scene file"}},
       {"cameras", "camera-up", "spz-axes", "lod"},
       "gaussians, rows of the file, cameras by name, remarks, and the camera as in the reply to camera"},
      {Ask::kCamera,
       "camera",
       "Looks from another camera: without fields from the one that cut would take",
       {},
       {"camera", "camera-pos", "camera-target", "camera-fov", "size"},
       "camera: name, size, position, remarks"},
      {Ask::kSettings,
       "settings",
       "Cuts by other settings: without fields by the program's own",
       {},
       {"preset", "set", "smoothness", "views", "first-mask", "propagate", "refine", "parts-only", "coarse"},
       "values of all settings; those of the object where there is one"},
      {Ask::kClick,
       "click",
       "Clicks a pixel of the camera",
       {{"x", kNumber, true, "Pixels from the left"}, {"y", kNumber, true, "Pixels from the top"}, kLabel},
       {},
       kObjectReply},
      {Ask::kScribble,
       "scribble",
       "Draws along points of the camera",
       {{"points", kList, true, "[[x, y], ...] in pixels"},
        {"radius_px", kNumber, false, "Half of its width, 3 by default"},
        kLabel},
       {},
       kObjectReply},
      {Ask::kBox,
       "box",
       "Draws a box around what is meant",
       {{"corners", kList, true, "[[x0, y0], [x1, y1]] in pixels"}, kLabel},
       {},
       kObjectReply},
      {Ask::kSize,
       "size",
       "Takes a larger or smaller part for the last click, or for the first box",
       {{"step", kWhole, true, "0 what it takes by itself, 1 the next larger, -1 the next smaller, ..."}},
       {},
       kObjectReply},
      {Ask::kChoice,
       "choice",
       "Takes another meaning of the first click",
       {{"choice", kWhole, true, "1 the likeliest, up to choices of the reply"}},
       {},
       kObjectReply},
      {Ask::kUndo, "undo", "Takes back the last click, scribble, box, size or choice", {}, {}, kObjectReply},
      {Ask::kClear, "clear", "Begins another object", {}, {}, "nothing"},
      {Ask::kPreview,
       "preview",
       "Draws the camera's picture as PNG",
       {{"what",
         kText,
         false,
         "The object tinted (default), the scene, the object alone or the rest",
         {"tint", "scene", "object", "rest"}},
        {"width", kWhole, false, "At most so many pixels wide"},
        kPath,
        kReplaces},
       {},
       "width, height; png (base64) or path"},
      {Ask::kLabels,
       "labels",
       "A byte per row of the scene file, 1 for the object",
       {{"path", kText, false,
         "File to write, for numpy where it ends with .npy; without it the reply holds the bytes as base64"},
        kReplaces},
       {},
       "rows, gaussians; labels (base64) or path"},
      {Ask::kExport,
       "export",
       "Writes the object or the rest as a scene file; its ending is the format",
       {{"path", kText, true, "File to write"},
        {"what", kText, false, "The object (default) or the rest", {"object", "rest"}},
        {"origin", kText, false, "What becomes 0, 0, 0", {kOriginNames.begin(), kOriginNames.end()}},
        {"up", kText, false, "Where up points in the file", {kUpNames.begin(), kUpNames.end()}},
        {"scale", kNumber, false, "Factor of all lengths"},
        kReplaces},
       {"edges", "fill", "scale-by"},
       "gaussians, bytes, path; edges with views, agreed, and why_kept or what was done; "
       "fill, not_given_back, loss of the format"},
      {Ask::kCancel,
       "cancel",
       "Stops a request that is running or waiting, which then replies that it was cancelled",
       {{"request", kList, true, "Its id"}},
       {},
       "cancelled: whether it was found"},
      {Ask::kClose, "close", "Closes the scene", {}, {}, "nothing"},
      {Ask::kQuit, "quit", "Ends the program once all requests before it are answered", {}, {}, "nothing"},
      {Ask::kDescribe, "describe", "Says which requests there are", {}, {}, "protocol, version, schema"},
  };
  return table;
}

struct TypeName {
  FieldType type;
  const char *in_schema, *in_words;
};
constexpr TypeName kTypes[] = {{kText, "string", "text"},
                               {kNumber, "number", "a number"},
                               {kWhole, "integer", "a whole number"},
                               {kSwitch, "boolean", "true or false"},
                               {kList, "array", "a list"}};

const TypeName& type_name(FieldType type) {
  return *std::ranges::find(kTypes, type, &TypeName::type);
}

constexpr int kMostWhole = 1000000;

bool is_of(FieldType type, const nlohmann::json& value) {
  switch (type) {
    case kText:
      return value.is_string();
    case kNumber:
      return value.is_number() && std::isfinite(value.get<double>());
    case kWhole:
      return value.is_number_integer() && std::abs(value.get<double>()) <= kMostWhole;
    case kSwitch:
      return value.is_boolean();
    case kList:
      return value.is_array();
  }
  return false;
}

void check_field(const RequestKind& kind, const RequestField& field, const nlohmann::json& value) {
  const std::string where = kind.name;
  if (kind.ask == Ask::kCancel) return;  // an id is text or a number
  if (value.is_number_integer() && !is_of(field.type, value) && field.type == kWhole)
    throw Error(where, fmt::format("\"{}\" is {}", field.name, json_text(value)),
                fmt::format("It takes a whole number from -{0} to {0}", kMostWhole));
  if (value == "") throw Error(where, fmt::format("\"{}\" is empty", field.name), field.sentence);
  if (!is_of(field.type, value))
    throw Error(where, fmt::format("\"{}\" is not {}", field.name, type_name(field.type).in_words));
  if (!field.values.empty() &&
      std::ranges::find(field.values, value.get<std::string>()) == field.values.end())
    throw Error(where, fmt::format("\"{}\" is {}", field.name, json_text(value)),
                "It takes " + spoken_list(field.values));
}

nlohmann::json schema_of(const RequestKind& kind, const CLI::App& cut) {
  nlohmann::json fields = {{"id", {{"type", {"string", "integer"}}}}, {"do", {{"const", kind.name}}}};
  nlohmann::json required = {"do"};
  for (const RequestField& field : kind.fields) {
    nlohmann::json one = {{"description", field.sentence}};
    one["type"] = kind.ask == Ask::kCancel ? nlohmann::json{"string", "integer"}
                                           : nlohmann::json(type_name(field.type).in_schema);
    if (!field.values.empty()) one["enum"] = field.values;
    fields[field.name] = one;
    if (field.required) required.push_back(field.name);
  }
  for (const std::string& name : kind.cut_options) {
    const CLI::Option* option = cut.get_option("--" + name);
    fields[name] = {{"description", option->get_description()}};
    fields[name]["type"] = option->get_expected_max() == 0 ? nlohmann::json("boolean")
                                                           : nlohmann::json{"string", "number", "array"};
  }
  return {{"title", kind.name},   {"description", kind.sentence}, {"type", "object"},
          {"properties", fields}, {"required", required},         {"additionalProperties", false},
          {"x-reply", kind.reply}};
}

}  // namespace

bool is_id(const nlohmann::json& value) {
  return value.is_string() || value.is_number_integer();
}

std::span<const RequestKind> request_kinds() {
  return kinds();
}

nlohmann::json request_from(std::string_view line) {
  return parse_json("request", line);
}

const RequestKind& checked_kind(const nlohmann::json& request) {
  const auto names = [] {
    std::vector<std::string> all;
    for (const RequestKind& kind : kinds()) all.push_back(kind.name);
    return "It takes " + spoken_list(all);
  };
  if (!request.is_object()) throw Error("request", "is no object with \"do\"", names());
  const auto asked = request.find("do");
  if (asked == request.end() || !asked->is_string()) throw Error("request", "has no \"do\"", names());
  const auto kind = std::ranges::find(kinds(), asked->get<std::string>(), &RequestKind::name);
  if (kind == kinds().end()) throw Error("request", fmt::format("\"do\" is {}", json_text(*asked)), names());
  for (const auto& [key, value] : request.items()) {
    if (key == "id" && !is_id(value))
      throw Error(kind->name, fmt::format("\"id\" is {}", json_text(value)),
                  "It takes text or a whole number");
    if (key == "id" || key == "do" || std::ranges::find(kind->cut_options, key) != kind->cut_options.end())
      continue;
    const auto field =
        std::ranges::find_if(kind->fields, [&key = key](const RequestField& f) { return f.name == key; });
    if (field == kind->fields.end())
      throw Error(kind->name, fmt::format("has no field \"{}\"", key), "describe lists them");
    check_field(*kind, *field, value);
  }
  for (const RequestField& field : kind->fields)
    if (field.required && !request.contains(field.name))
      throw Error(kind->name, fmt::format("lacks \"{}\"", field.name), field.sentence);
  return *kind;
}

nlohmann::json request_schema() {
  CLI::App cut;
  CutArguments args;
  args.add_to(cut);
  nlohmann::json all = nlohmann::json::array();
  for (const RequestKind& kind : kinds()) all.push_back(schema_of(kind, cut));
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"title", fmt::format("Requests of splatcut serve, protocol {}", kProtocol)},
          {"oneOf", all}};
}

}  // namespace splatcut
