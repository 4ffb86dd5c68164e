// Which way is up, as scene files say it. Internal to src/scene/formats.
//
//   .ply, .compressed.ply   a line of the header, comment up 0 0 1
//   .spz 3                  gzip's comment, "...; up 0 0 1"
//   .spz 4                  a record of its own (spz_layout.h)
//   .sog                    "up": [0, 0, 1] in meta.json
//   .glb                    "up": [0, 0, 1] in the extras of the scene
//   .usda                   upAxis, which has Y and Z alone
//
// Three numbers in the axes of the file, of any length. Comments of others on an axis that is vertical are
// not read: common programs write one and the same whatever they write.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "scene/formats/axis_signs.h"
#include "scene/formats/scene_file.h"
#include "scene/packing/ply_header.h"

namespace splatcut {

// What a file says, in its axes, before it is checked; NaN for what is no three numbers.
using SaidUp = std::optional<glm::dvec3>;

// "0 0 1", as a .ply has it behind `comment up` and a .spz behind `; up`.
glm::dvec3 up_from_words(std::string_view words);
// Of the first comment that begins with the word "up".
SaidUp up_from_header(const PlyHeader& header);
// Of "up" in the object; none where it has none, or is no object.
SaidUp up_from_json(const nlohmann::json& holder);

// Sets Scene::up. Of what is no direction a sentence in Scene::oddity says that it is passed over.
void take_up(const SaidUp& said, const AxisSigns& axes, Scene* scene);

// A direction in the axes of a file, to six digits, so that what was turned there is written as whole
// numbers.
glm::dvec3 up_to_say(const glm::vec3& up, const AxisSigns& axes);
std::string words_for_up(const glm::vec3& up, const AxisSigns& axes);
// The line of a .ply's header, empty for none, and whether a line is one.
std::string up_comment(const std::optional<glm::vec3>& up);
bool is_up_comment(std::string_view line);
// Sets "up" of the object where it is known.
void add_up(const std::optional<glm::vec3>& up, const AxisSigns& axes, nlohmann::json* holder);

}  // namespace splatcut
