// How well an object was seen: by how many views each of its Gaussians, and from which sides all of it.
//
// Views: its own ones (own_views.h), of the capture where that has enough. A Gaussian is seen by a view to
// which the scene leaves a quarter of what the object alone shows of it. Sides: six, two along the scene's up
// and four level ones, the first towards the camera that one looks from. A side is seen as far as cameras
// within 60 degrees of it saw it, of the capture where it has any, the three nearest to the side; else four
// there: what the scene itself hides from below, nobody saw. The share is that of the object's picture alone
// which the scene leaves visible. Cost: a drawing of the scene and of the object a view, and for the sides up
// to 24 of both, 160 pixels wide, around the object alone. Same input, same bits.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/job.h"
#include "segment/finish/own_views.h"

namespace splatcut {

inline constexpr std::array<const char*, 6> kSideNames = {"front", "right", "back", "left", "above", "below"};
inline constexpr std::size_t kLevelSides = 4;  // the first ones

struct SeenFrom {
  std::vector<glm::vec3> views;  // directions from the object to those that were looked at, unit
  std::vector<std::uint32_t>
      by_views;  // per labelled Gaussian, in the scene's order: a bit for each that sees it
  std::array<glm::vec3, 6> sides{};      // directions, unit
  std::array<float, 6> side_share{};     // of kSideNames, in [0, 1]
  std::array<Camera, 6> side_cameras{};  // that look at the object from there
  bool has_front = true;  // false: one looks from straight above or below; level sides have no names then
  std::vector<std::string> never() const;  // names of the sides that were not seen: see kLeastSeenShare
  // Of the object's surface: the mean over the sides of what no view saw, [0, 1]. A side of which as much as
  // kEnoughSeenShare was seen counts as all seen: no more of it was looked for.
  float unseen_share() const;
};

// How much of an object was seen from a side: the share of its picture alone, 160 pixels wide, that the scene
// leaves visible to a camera there. Refers to scene, labels and cameras.
class SeenSides {
 public:
  // towards: from the object to where the user looks from, any length. cameras: of the capture, may be empty.
  SeenSides(const Drawer& scene, std::span<const std::uint8_t> labels, const glm::vec3& up_world,
            const glm::vec3& towards, std::span<const Camera> cameras);

  // side: direction from the object, unit. The largest of three cameras of the capture within 60 degrees of
  // it with the object's middle in their picture, those nearest to it, 0 where it has none; without a capture
  // of four there. Not all are asked where one sees `enough`. Cancelled: unspecified.
  float share(const glm::vec3& side, float enough, const Job& job) const;

  const GaussianCloud& alone() const { return alone_; }  // the labelled Gaussians, in the scene's order
  const ObjectExtent& extent() const { return extent_; }
  Camera looking_from(const glm::vec3& direction) const;  // at the object, 160 x 160 pixels

 private:
  Drawer scene_;
  std::span<const std::uint8_t> labels_;
  glm::vec3 up_, front_;
  std::span<const Camera> cameras_;
  GaussianCloud alone_;
  ObjectExtent extent_;
};

// Less than the first is as good as not seen; where a camera sees as much as the second, no other is asked.
inline constexpr float kLeastSeenShare = 0.1f, kEnoughSeenShare = 0.9f;

// The views and what each saw of the Gaussians; `sides` and what belongs to them stay empty. cameras: of the
// capture, may be empty. Cancelled: unspecified.
SeenFrom seen_by_views(const Drawer& scene, std::span<const std::uint8_t> labels, const glm::vec3& up_world,
                       std::span<const Camera> cameras, const Job& job);

// The sides; `views` and `by_views` stay empty. At least one Gaussian is labelled. from_world: where the user
// looks from. Cancelled: unspecified.
SeenFrom seen_sides(const Drawer& scene, std::span<const std::uint8_t> labels, const glm::vec3& up_world,
                    const glm::vec3& from_world, std::span<const Camera> cameras, const Job& job);

// Both.
SeenFrom seen_from(const Drawer& scene, std::span<const std::uint8_t> labels, const glm::vec3& up_world,
                   const glm::vec3& from_world, std::span<const Camera> cameras, const Job& job);

// The object from the six sides, two rows of three on dark: red, which no view from around that side saw, and
// from yellow to blue the more of them did.
Image<Rgb8> seen_picture(const SeenFrom& seen, const Drawer& scene, std::span<const std::uint8_t> labels,
                         const Job& job);

}  // namespace splatcut
