// The request for one object: strokes, masks, views; no settings.
//
// The same request, settings and session give the same labels, bit for bit.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "scene/camera/camera.h"
#include "segment/masks/seeds.h"
#include "segment/selection/carried_labels.h"

namespace splatcut {

// Strokes of one view, in order. Strokes: in the camera's pixels.
struct StrokedView {
  Camera camera;
  Strokes strokes;
  SeenGaussians seen{};  // they affect these alone; null: all
};

// A view whose mask is known. Mask: any size of the camera's aspect ratio.
struct GivenView {
  Camera camera;
  Mask mask;
};

// Gives the mask of a view in place of the cut's own (truth in experiments, masks of other tools).
using MaskSource = std::function<Mask(const Camera&)>;

struct CutRequest {
  // In the order in which they were made; a camera may come more than once. The first view with an object
  // stroke is the reference.
  std::vector<StrokedView> strokes;
  std::optional<GivenView> first_mask;  // its camera is then the reference
  std::vector<GivenView> masks;         // of other views, in place of an orbit
  MaskSource mask_source;               // of every orbit view
  std::vector<Camera> views;            // to look from beside the reference; empty: an orbit
  std::vector<Camera> left_out;         // views that do not count, the reference apart
  int choice = 0;                       // of what the first click can mean, 0 the likeliest
  std::optional<glm::vec3> up_world;    // where the user says which way is up; the session's otherwise
  SeenGaussians among{};                // the scene is cut as if it had these alone; null: all
  CarriedLabels carried{};              // Session's own, between its places; what it is asked for has none
};

std::size_t stroke_count(const CutRequest& request);

// The strokes by view, as they are told apart by same_view(): each view once, in order of its first stroke.
std::vector<StrokedView> strokes_by_view(const std::vector<StrokedView>& strokes);

bool marks_object(const StrokedView& view);

// The stroke that is applied first (in_replay_order()), that on the object which was made first, and the one
// that was made last; null: no stroke marks the object.
Stroke* first_stroke(std::vector<StrokedView>* strokes);
Stroke* last_stroke(std::vector<StrokedView>* strokes);
const Stroke* first_stroke(const std::vector<StrokedView>& strokes);
const Stroke* last_stroke(const std::vector<StrokedView>& strokes);
// True if that says what does not belong to the object: a larger part of it is more taken away.
bool last_takes_away(const std::vector<StrokedView>& strokes);

// Gives the strokes these sizes, in the order in which they are applied. Those beyond keep their own.
void set_size_steps(std::span<const int> steps, std::vector<StrokedView>* strokes);

// What is clicked in: the camera of the first mask, or the first view with an object stroke; null: nothing
// marks the object. Strokes: those of `by_view` there.
struct ReferenceView {
  Camera camera;
  Strokes strokes;
};
std::optional<ReferenceView> reference_of(const CutRequest& request, const std::vector<StrokedView>& by_view);

// The request as bytes, for keys, not for files. Equal bytes mean equal results, unless there is a mask
// source, whose masks are unknown until it is asked. Masks enter by their 64-bit hash.
std::string key_of(const CutRequest& request);

// Its strokes alone, in their order.
std::string key_of_strokes(const CutRequest& request);

// Its first stroke on the object without its size, with its view: what the meanings of the first click depend
// on. Empty: none.
std::string key_of_first_stroke(const CutRequest& request);

// Its strokes and choice without the size of the last one: what the sizes of that depend on. Empty: no stroke
// marks the object.
std::string key_of_last_stroke(const CutRequest& request);

// The part of the key that the cut from the reference depends on, see session.h.
std::string key_of_reference(const CutRequest& request, const ReferenceView& reference);

}  // namespace splatcut
