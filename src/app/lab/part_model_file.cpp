#include "app/lab/part_model_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

constexpr const char* kVersionKey = "splatcut_part_model";

}  // namespace

nlohmann::json part_model_json(const PartModel& model) {
  nlohmann::json weights;
  for (const PartWeight& weight : part_weights()) weights[weight.name] = weight.get(model);
  return {{kVersionKey, PartModel::kVersion}, {"weights", weights}};
}

PartModel load_part_model(const std::filesystem::path& path) {
  const nlohmann::json file = json_of_file(path);
  if (!file.is_object() || !file.contains(kVersionKey) ||
      !file.value("weights", nlohmann::json()).is_object())
    throw Error(path.string(), "is no model of parts", "splatcut-lab fit writes one");
  if (file.at(kVersionKey) != PartModel::kVersion)
    throw Error(path.string(), fmt::format("is of another version than {}", PartModel::kVersion),
                "Its weights mean something else; fit it again");
  PartModel model;
  for (const auto& [name, value] : file.at("weights").items()) {
    const auto weight = std::ranges::find(part_weights(), name, &PartWeight::name);
    if (weight == part_weights().end() || !value.is_number())
      throw Error(path.string(), fmt::format("\"{}\" is no weight, or no number", name));
    weight->set(&model, value.get<double>());
  }
  return model;
}

}  // namespace splatcut
