// The object on black as a picture, and how near it comes to the truth's.
//
// Drawn: the labelled Gaussians in their own colours, everything else black and occluding, as in the pictures
// of labels. The truth's picture is the same of the true labels; where only masks are known, the scene's own
// picture, black outside the true mask. Either way the capture's own errors do not count, unlike against
// photographs.
#pragma once

#include <cstdint>
#include <vector>

#include "app/measure/evaluate.h"
#include "core/image.h"

namespace splatcut {

inline constexpr double kEqualPicturesDb =
    100;  // PSNR where two pictures are equal, and the most that counts

Image<Rgb8> object_on_black(const GaussianCloud& cloud, const Camera& camera,
                            const std::vector<std::uint8_t>& labels);

struct PictureScore {
  double psnr_db = 0, ssim = 0;
};

// Means over the test views that count. Throws Error where the truth shows in none.
PictureScore score_pictures(const EvaluationCase& scene, const std::vector<std::uint8_t>& labels);

}  // namespace splatcut
