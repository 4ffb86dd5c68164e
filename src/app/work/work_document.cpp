#include "app/work/work_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/console/seeds_file.h"
#include "app/work/work_values.h"
#include "core/error.h"

namespace splatcut {

using nlohmann::json;

namespace {

json object_json(const Document& document, const ObjectItem& o, const WriteFlags& flags) {
  json views = json::array();
  for (const StrokedView& view : o.views)
    views.push_back({{"camera", camera_json(view.camera)},
                     {"strokes", strokes_json(view.strokes)},
                     {"seen", flags(view.seen)}});
  json left_out = json::array();
  for (const Camera& camera : o.left_out) left_out.push_back(camera_json(camera));
  json out = {{"id", o.id},
              {"name", o.name},
              {"colour", {o.colour[0], o.colour[1], o.colour[2]}},
              {"visible", o.tinted},
              {"locked", o.locked},
              {"within", o.within},
              {"views", views},
              {"choice", o.choice},
              {"left_out", left_out},
              {"cut", flags(o.cut)},
              {"cut_is_current", o.cut != nullptr && !is_stale(document, o)},
              {"hand", flags(o.hand)}};
  if (o.smoothness) out["smoothness"] = *o.smoothness;
  if (o.up_world) out["up"] = list(*o.up_world);
  if (o.cut_kept) out["cut_is_kept"] = true;
  if (o.of_others) out["of_others"] = flags(o.of_others);
  if (o.among) out["among"] = flags(o.among);
  if (!o.leaves_also.empty()) out["leaves_also"] = o.leaves_also;
  return out;
}

ObjectItem object_from(const json& j, const ReadFlags& flags) {
  ObjectItem o;
  o.id = j.at("id");
  o.name = j.at("name");
  for (std::size_t c = 0; c < 3; ++c) o.colour[c] = j.at("colour").at(c);
  o.tinted = j.value("visible", true);
  o.locked = j.value("locked", false);
  o.within = j.value("within", 0u);
  if (o.within >= o.id) throw Error("object", "\"" + o.name + "\" cannot be a part of a later one");
  for (const json& view : j.at("views"))
    o.views.push_back({camera_from(view.at("camera")), strokes_from(view.at("strokes")),
                       flags(view.value("seen", json()), 1)});
  o.choice = j.value("choice", 0);
  if (Stroke* first = first_stroke(&o.views); first && j.contains("part_step"))  // until version 8
    first->size_step = size_step_from_json(j, "part_step", "object");
  for (const json& camera : j.value("left_out", json::array())) o.left_out.push_back(camera_from(camera));
  if (j.contains("up")) o.up_world = direction_from(j.at("up"));
  if (j.contains("smoothness")) o.smoothness = j.at("smoothness").get<float>();
  o.cut = flags(j.value("cut", json()), 1);
  o.cut_kept = o.cut && j.value("cut_is_kept", false);
  o.hand = flags(j.value("hand", json()), kHandLeft);
  o.of_others = flags(j.value("of_others", json()), 1);
  o.among = flags(j.value("among", json()), 1);
  o.leaves_also = j.value("leaves_also", o.leaves_also);
  return o;
}

}  // namespace

json document_json(const Document& document, const WriteFlags& flags) {
  json objects = json::array();
  for (const ObjectItem& o : document.objects) objects.push_back(object_json(document, o, flags));
  return {{"active", document.active},
          {"next_id", document.next_id},
          {"up", list(document.up_world)},
          {"preset", document.preset},
          {"background", list(document.background)},
          {"deleted", flags(document.deleted)},
          {"objects", std::move(objects)}};
}

Document document_from(const json& j, std::span<const json* const> objects, const ReadFlags& flags,
                       std::string* unknown_preset) {
  Document d;
  d.active = j.value("active", 0u);
  d.next_id = j.at("next_id");
  d.up_world = direction_from(j.at("up"));
  d.preset = j.at("preset");
  if (unknown_preset && std::ranges::none_of(presets(), [&](const Preset& p) { return d.preset == p.name; }))
    *unknown_preset = std::exchange(d.preset, presets().front().name);
  preset(d.preset);  // throws for an unknown one
  d.background = vec3_from(j.at("background"));
  d.deleted = flags(j.value("deleted", json()), 1);
  if (objects.size() > kMostObjects)
    throw Error("objects", fmt::format("there are {}, more than {}", objects.size(), kMostObjects));
  for (const json* said : objects) {
    ObjectItem o = object_from(*said, flags);
    if (o.id == 0 || o.id >= d.next_id || d.find(o.id))
      throw Error("objects", fmt::format("the id {} is used twice or out of range", o.id));
    if (o.cut && said->value("cut_is_current", false)) o.cut_key = cut_key(d, o);
    d.objects.push_back(std::move(o));
  }
  return d;
}

}  // namespace splatcut
