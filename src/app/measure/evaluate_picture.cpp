#include "app/measure/evaluate_picture.h"

#include <algorithm>

#include "core/error.h"
#include "core/picture_difference.h"
#include "core/png_file.h"
#include "scene/raster/rasterizer.h"
#include "scene/raster/splat_math.h"

namespace splatcut {

namespace {

Image<Rgb8> true_picture(const EvaluationCase& scene, std::size_t view) {
  const Camera& camera = scene.test_views[view];
  if (!scene.truth_labels.empty()) return object_on_black(*scene.cloud, camera, scene.truth_labels);
  Image<Rgb8> picture = rgb8_from_linear(rasterize(*scene.cloud, camera).colour);
  for (std::size_t i = 0; i < picture.size(); ++i)
    if (!scene.truth_masks[view].pixels()[i]) picture.pixels()[i] = {};
  return picture;
}

}  // namespace

Image<Rgb8> object_on_black(const GaussianCloud& cloud, const Camera& camera,
                            const std::vector<std::uint8_t>& labels) {
  std::vector<glm::vec3> colour(cloud.size());
  const glm::vec3 eye = camera.centre_world();
  for (std::size_t g = 0; g < cloud.size(); ++g)
    if (labels[g])
      colour[g] = sh_colour(cloud.f_dc[g], cloud.sh_rest_of(g), cloud.sh_degree,
                            glm::normalize(cloud.position[g] - eye));
  RasterOptions options;
  options.colour_override = colour;
  return rgb8_from_linear(rasterize(cloud, camera, options).colour);
}

PictureScore score_pictures(const EvaluationCase& scene, const std::vector<std::uint8_t>& labels) {
  PictureScore sum;
  int views = 0;
  for (std::size_t v = 0; v < scene.test_views.size(); ++v) {
    if (!counts(scene.truth_masks[v])) continue;
    const PictureDifference d = picture_difference(
        true_picture(scene, v), object_on_black(*scene.cloud, scene.test_views[v], labels));
    sum.psnr_db += std::min(d.psnr_db, kEqualPicturesDb);
    sum.ssim += d.ssim;
    ++views;
  }
  if (views == 0) throw Error(scene.name, "the truth shows in none of its test views");
  return {sum.psnr_db / views, sum.ssim / views};
}

}  // namespace splatcut
