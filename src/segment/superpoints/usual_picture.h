// How broadly a thing is usually shown: whole. A user may stand so near that the picture crops what is meant.
//
// A picture's breadth at a point: the side of a square as large as the picture's area there, scene units.
// Usual is what the photographs that show the point have. A scene without cameras is known by its subject,
// what was captured most finely (scene/cloud/captured_detail.h): its pictures are 2.3 of its radii broad. (On
// 17 captures of one thing photographs were 1.9 to 5.5 radii broad.) What is looked at from so near that this
// would be more than 3.3 times as broad is no picture of the subject, but of one thing among many: in rooms
// and gardens the radius is three to ten times the breadth of photographs.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scene/camera/camera.h"
#include "scene/cloud/captured_detail.h"

namespace splatcut {

inline constexpr std::ptrdiff_t kEnoughPhotographs = 3;  // to know a place by them alone

// What is known of how a scene was photographed.
struct Capture {
  std::vector<Camera> photographs;  // may be empty
  Ball subject;                     // looked at where there are no photographs
};

inline const Capture kUnknownCapture{};

Capture capture_of(const GaussianCloud& cloud, std::span<const Camera> photographs);

struct UsualPicture {
  float distance = 0, breadth = 0;  // medians over the photographs that show the point, scene units
  float times_own = 1;              // `breadth`, in breadths of the picture that it was asked for
};

// Nothing where there are photographs, but fewer than kEnoughPhotographs show the point; and without any
// where the camera is no close-up of the subject: then the camera's own picture serves.
std::optional<UsualPicture> usual_picture(const Camera& camera, const Capture& capture,
                                          const glm::vec3& point_world);

// True if this picture shows so much less around the point that it may not hold what is meant: its breadth
// there is less than two thirds of the usual one.
bool is_close_up(const std::optional<UsualPicture>& usual);

// With these margins a picture that is_close_up() has the usual breadth, or three times its own if that is
// less. None around another.
Margins margins_of_close_up(const Camera& camera, const std::optional<UsualPicture>& usual);

}  // namespace splatcut
