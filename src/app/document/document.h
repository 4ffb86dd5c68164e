// The document: what the user makes, that is objects with their strokes and labels, and the settings that
// change them. A document is a value. Copies share their large arrays, so that one copy per undo step is
// cheap and undo is exact.
#pragma once

#include <cstdint>
#include <functional>
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

// One byte per Gaussian of the cloud, immutable. A null pointer means all zero, unless a comment says
// otherwise.
using Flags = std::shared_ptr<const std::vector<std::uint8_t>>;
Flags make_flags(std::vector<std::uint8_t> values);

using ObjectId = std::uint32_t;  // id of an object, never used twice in a document; 0: no object

// Mark that the user gave a Gaussian by hand; it overrides the cut. kHandLeft: kHandObject that was left to
// other objects afterwards, see set_of_others(): it counts as kFollowCut until `of_others` no longer holds
// it.
enum HandMark : std::uint8_t { kFollowCut = 0, kHandObject = 1, kHandRest = 2, kHandLeft = 3 };

struct ObjectItem {
  ObjectId id = 0;
  std::string name;
  Rgb8 colour{255, 140, 30};
  bool tinted = true;  // the window tints and outlines it
  bool locked = false;
  ObjectId within = 0;                // earlier object that this is a part of: no labels outside of it count
  std::vector<StrokedView> views;     // views with their strokes, in the order of the strokes, see CutRequest
  int choice = 0;                     // meaning of the first click that is taken, 0 the likeliest
  std::vector<Camera> left_out;       // views that do not count, see CutRequest
  std::optional<glm::vec3> up_world;  // up direction at the first stroke; none: the document's
  std::optional<float> smoothness;    // weight of the neighbour term; none: the preset's own
  Flags cut;                          // labels that the cut gave, 1 = object
  std::string cut_key;                // cut_key() of the inputs of `cut`; empty: there is no cut yet
  // What the scene had at the first stroke, without what was added or moved since: the object is cut among
  // these alone until a stroke marks something else; null: all.
  Flags among;
  // True if `cut` is older than the scene's present files: it stays as it is until the next stroke.
  bool cut_kept = false;
  Flags hand;       // HandMark of each Gaussian
  Flags of_others;  // Gaussians that stay other objects' own: the cut takes none of them; null: it takes any
  // Objects whose cut was on its way when `of_others` was set: what it gives them joins that once it is
  // there.
  std::vector<ObjectId> leaves_also;
};

inline constexpr std::size_t kMostObjects = 255;  // limit, as one byte per Gaussian names its object

struct Document {
  std::vector<ObjectItem> objects;  // objects, at most kMostObjects
  ObjectId active = 0;
  ObjectId next_id = 1;
  glm::vec3 up_world{0, -1, 0};
  std::string preset = "default";
  glm::vec3 background{0.11f, 0.115f, 0.125f};
  Flags deleted;  // Gaussians that the user deleted: they are neither drawn nor exported

  const ObjectItem* find(ObjectId id) const;
  ObjectItem* find(ObjectId id);
  const ObjectItem* active_object() const { return find(active); }
};

// The request that cuts an object, and the settings for that cut.
CutRequest cut_request(const Document& document, const ObjectItem& object);
CutSettings cut_settings(const Document& document, const ObjectItem& object);

// Returns the camera of an earlier stroke of the object in the same view, else `camera` itself.
Camera known_camera(const ObjectItem& object, const Camera& camera);

// Request and settings as bytes: two keys are equal if and only if the labels must be. For comparison in
// memory, not for files.
std::string cut_key(const Document& document, const ObjectItem& object);

std::size_t stroke_count(const ObjectItem& object);  // clicks, scribbles and boxes, of all its views

// True if `cut` was computed from another request or other settings. key: the object's present cut_key().
bool is_stale(const Document& document, const ObjectItem& object);
bool is_stale(const ObjectItem& object, const std::string& key);

// Final labels, one per Gaussian, 1 = object: the cut without `of_others`, corrected by hand marks, deletions
// and `within`. gaussians: size of the cloud.
std::vector<std::uint8_t> labels_of(const Document& document, const ObjectItem& object,
                                    std::size_t gaussians);

// One of these labels.
bool has(const Document& document, const ObjectItem& object, std::size_t gaussian);

// True if an object is a part of `whole`, or a part of such a part.
bool is_part_of(const Document& document, const ObjectItem& part, ObjectId whole);

// What follows asks for labels of many objects. known: cache of the calling thread, which has most of them;
// null: they are computed.
class LabelCache;

// All that other objects have, but for parts of this one and wholes that it is a part of; null: nothing.
// only: the one that counts, 0: all.
Flags had_by_others(const Document& document, const ObjectItem& object, std::size_t gaussians,
                    ObjectId only = 0, LabelCache* known = nullptr);

// What locked ones of these have and the object has not: nothing gives it that; null: nothing.
Flags kept_by_locked(const Document& document, const ObjectItem& object, std::size_t gaussians,
                     LabelCache* known = nullptr);
// Leaves that to them, too.
void leave_to_locked(const Document& document, ObjectItem* object, std::size_t gaussians,
                     LabelCache* known = nullptr);
// Leaves the same of one that was locked now to each of the others. It costs rows x objects, as the window
// waits for it.
void leave_to_locked_one(Document* document, const ObjectItem& locked, std::size_t gaussians);
// The locked object that keeps more than half of what a stroke hits from this one; null: none does.
const ObjectItem* locked_under(const Document& document, const ObjectItem& object,
                               std::span<const std::int32_t> hits);

// Whether the object leaves to others all that it is to leave, also what a hand took since, and not to
// locked ones alone.
bool is_without_others(const Document& document, const ObjectItem& object, std::size_t gaussians,
                       LabelCache* known = nullptr);

// Sets ObjectItem::of_others, with nothing on its way. What hands took of that is left to the others, too;
// what hands had taken of what was left before is the object's again.
void set_of_others(ObjectItem* object, Flags of_others);
// Sets it where that was left before hands took some of it: they keep that. What is on its way stays so.
void set_left_earlier(ObjectItem* object, Flags of_others);
// Lets the object take what those others and their parts have who have most of what a stroke hits; where none
// has it any more, all that none has. What locked ones have, and what it leaves to the remaining ones, stays
// theirs, also where those that are hit have it, too. of_others: not null.
void share_what_is_hit(const Document& document, ObjectItem* object, std::span<const std::int32_t> hits,
                       std::size_t gaussians, LabelCache* known = nullptr);
// Sets it to nothing but what locked ones keep.
void share_again(const Document& document, ObjectItem* object, std::size_t gaussians,
                 LabelCache* known = nullptr);
// Sets it to all that other objects have, and have on their way.
void leave_to_others(const Document& document, ObjectItem* object, std::size_t gaussians,
                     LabelCache* known = nullptr);
// The object with what the objects `came`, of its `leaves_also`, have now. hits: asked for the Gaussians that
// each of its strokes hits where they have anything; a stroke that means one of these objects shares with it
// alone.
using HitsOfStrokes = std::function<std::vector<std::vector<std::int32_t>>()>;
ObjectItem left_what_came(const Document& document, const ObjectItem& object, std::span<const ObjectId> came,
                          const HitsOfStrokes& hits, std::size_t gaussians, LabelCache* known = nullptr);

// Whether a stroke that hits these Gaussians means what the object leaves to one of the others: that has more
// than half of them.
bool means_what_is_left(const Document& document, const ObjectItem& object,
                        std::span<const std::int32_t> hits);

// Whether a stroke is made on what the object is not cut among: more than half of what it hits is not.
bool reaches_beyond(const ObjectItem& object, std::span<const std::int32_t> hits);

// Sets hand marks so that the final labels become `labels`. taken_out: Gaussians that hands took out, which
// the object does not get back from others either; empty: none.
void set_labels(Document* document, ObjectItem* object, std::span<const std::uint8_t> labels,
                std::span<const std::uint8_t> taken_out = {});

// Adds an object with a name and a colour of its own, and makes it active. Throws Error if there are
// kMostObjects already.
ObjectItem& add_object(Document* document, std::string name = {});

// Gives the object another of those colours where its own hardly shows on `under` (sRGB, [0, 1]) or another
// object has it: the one that is farthest from that and from the other objects' colours.
void stand_out(Document* document, ObjectId object, const glm::vec3& under);

std::size_t count_flags(std::span<const std::uint8_t> flags);  // number of bytes that are not 0

// same(): everything is equal. same_but_strokes(): everything is equal but what cut_key() covers.
bool same(const Document& a, const Document& b);
bool same_but_strokes(const Document& a, const Document& b);

}  // namespace splatcut
