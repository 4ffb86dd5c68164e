// What the user makes: objects with their strokes and labels, and the settings that change them. A value:
// copies share their large arrays, so that keeping one per undo step is cheap and undo is exact.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "segment/session/cut_request.h"
#include "segment/session/cut_settings.h"

namespace splatcut {

// One byte per Gaussian of the cloud, immutable; null means all zero.
using Flags = std::shared_ptr<const std::vector<std::uint8_t>>;
Flags make_flags(std::vector<std::uint8_t> values);

using ObjectId = std::uint32_t;  // never used twice in a document; 0 is none

// Manual mark of a Gaussian; overrides the cut.
enum HandMark : std::uint8_t { kFollowCut = 0, kHandObject = 1, kHandRest = 2 };

struct ObjectItem {
  ObjectId id = 0;
  std::string name;
  Rgb8 colour{255, 140, 30};
  bool visible = true;
  bool locked = false;
  ObjectId within = 0;                // part of that object: labels outside of it do not count
  std::vector<StrokedView> views;     // in the order in which they were stroked, see CutRequest
  int choice = 0;                     // of what the first click can mean, 0 the likeliest
  int part_step = 0;                  // sizes above or below that meaning's own
  std::vector<Camera> left_out;       // views that do not count, see CutRequest
  std::optional<glm::vec3> up_world;  // as it was at the first stroke; the document's where not given
  std::optional<float> smoothness;    // the preset's own where not given
  Flags cut;                          // labels from the strokes, 1 = object
  std::string cut_key;                // cut_key() of what they were computed from; empty: none yet
  bool cut_kept = false;              // computed before the scene got other files; the next stroke ends that
  Flags hand;                         // HandMark
};

inline constexpr std::size_t kMostObjects = 255;  // one byte per Gaussian names its object

struct Document {
  std::vector<ObjectItem> objects;  // at most kMostObjects
  ObjectId active = 0;
  ObjectId next_id = 1;
  glm::vec3 up_world{0, -1, 0};
  std::string preset = "default";
  glm::vec3 background{0.11f, 0.115f, 0.125f};
  Flags deleted;  // Gaussians taken out of the scene: neither drawn nor exported

  const ObjectItem* find(ObjectId id) const;
  ObjectItem* find(ObjectId id);
  const ObjectItem* active_object() const { return find(active); }
};

// The request for an object, and the settings to cut it with.
CutRequest cut_request(const Document& document, const ObjectItem& object);
CutSettings cut_settings(const Document& document, const ObjectItem& object);

// The camera of an earlier stroke of the object in the same view, else the camera itself.
Camera known_camera(const ObjectItem& object, const Camera& camera);

// Request and settings as bytes, for keys, not for files: equal if and only if the labels must be.
std::string cut_key(const Document& document, const ObjectItem& object);

// True if `cut` was computed from another request or other settings.
bool is_stale(const Document& document, const ObjectItem& object);
bool is_stale(const ObjectItem& object, const std::string& key);  // key: its cut_key()

// Final labels (1 = object): cut, hand marks, `within` and deleted together. Size: `gaussians`.
std::vector<std::uint8_t> labels_of(const Document& document, const ObjectItem& object,
                                    std::size_t gaussians);

// The final labels become `labels`: what differs from the cut is marked by hand.
void set_labels(Document* document, ObjectItem* object, std::span<const std::uint8_t> labels);

// A new object, active, with a name and a colour of its own. Throws Error where there are kMostObjects.
ObjectItem& add_object(Document* document, std::string name = {});

std::size_t count_flags(std::span<const std::uint8_t> flags);

// Everything in them is equal; all but what cut_key() covers is.
bool same(const Document& a, const Document& b);
bool same_but_strokes(const Document& a, const Document& b);

}  // namespace splatcut
