// Clicks, boxes and scribbles from a file or from the command line.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "segment/masks/seeds.h"

namespace splatcut {

// {"clicks": [{"x","y","label":"object"|"rest"}], "boxes": [{"label","corners":[[x,y],[x,y]]}],
//  "scribbles": [{"label","radius_px","points":[[x,y],...]}]}. Boxes come first, as clicks correct them.
// Clicks and boxes may have a "scale", which becomes their Stroke::size_step.
Strokes strokes_from_json(const nlohmann::json& seeds, const std::string& where);

// Throws Error for a field that is none of seeds, or of one of several objects (in_list), and for one that is
// none of a click, a box or a scribble in them: a misspelt one would change what is meant.
void refuse_unknown_seeds(const nlohmann::json& seeds, const std::string& where, bool in_list = false);

// Stroke::size_step under that key, 0 where there is none. Throws Error where it is no step.
int size_step_from_json(const nlohmann::json& stroke, const char* key, const std::string& where);

// Throws Error where the radius or a point cannot be one of a picture, and where a box is none.
void check_stroke(const Stroke& stroke, const std::string& where);

// Beside them an optional "choice": from 1 to kMostMeanings, which of its meanings the first click has, by
// likelihood and as the window numbers them. Returns one less; 0 where there is none.
int choice_from_json(const nlohmann::json& seeds, const std::string& where);

// "x,y", "x,y:object" or "x,y:rest".
Stroke parse_click(const std::string& text);

// The same of a box, "x0,y0,x1,y1": any two opposite corners.
Stroke parse_box(const std::string& text);

}  // namespace splatcut
