// Writer of .sog, version 2, as one file.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "scene/cloud/moved_far.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/losses.h"
#include "scene/formats/said_up.h"
#include "scene/formats/sog.h"
#include "scene/packing/packed_size.h"
#include "scene/packing/palette.h"
#include "scene/packing/webp.h"
#include "scene/packing/zip_file.h"

namespace splatcut {

namespace {

using nlohmann::json;

constexpr std::size_t kMostPalette = 1 << 16;  // a label has 16 bits

// Wide enough for all, sides a multiple of 4, nearly square.
Image<Rgba8> picture_for(std::size_t count) {
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const std::size_t width = (side + 3) / 4 * 4, height = ((count + width - 1) / width + 3) / 4 * 4;
  return {static_cast<int>(width), static_cast<int>(height), Rgba8{0, 0, 0, 255}};
}

struct SogPictures {
  std::vector<std::string> names;
  std::vector<Image<Rgba8>> images;

  Image<Rgba8>& add(const std::string& name, Image<Rgba8> image) {
    names.push_back(name + ".webp");
    return images.emplace_back(std::move(image));
  }
};

struct SogInput {
  const GaussianCloud& cloud;
  std::vector<std::uint32_t> gaussians;  // in Morton order: neighbours look alike, and pack well

  std::size_t size() const { return gaussians.size(); }
};

json list_of(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

// Positions as 16 bits between the least and the most of their logarithms.
struct SogMeans {
  glm::vec3 least{std::numeric_limits<float>::infinity()}, most{-std::numeric_limits<float>::infinity()};
  glm::vec3 moves{0};  // of 1 + |coordinate|: twice what rounding to a step moves it by at most

  SogMeans(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) {
    for (const std::uint32_t g : gaussians) {
      least = glm::min(least, cloud.position[g]);
      most = glm::max(most, cloud.position[g]);
    }
    least = log_of(least);  // which grow with the coordinates
    most = log_of(most);
    constexpr float kRounding = 1e-6f;  // of single precision in read_back(), of the largest logarithm
    const glm::vec3 off = range() / sog::kSteps + kRounding * glm::max(glm::abs(least), glm::abs(most));
    for (int c = 0; c < 3; ++c) moves[c] = std::expm1(off[c]);
  }
  static glm::vec3 log_of(const glm::vec3& p) {
    return {sog::to_log(p.x), sog::to_log(p.y), sog::to_log(p.z)};
  }
  glm::vec3 range() const { return glm::max(most - least, std::numeric_limits<float>::min()); }
  glm::uvec3 steps_of(const glm::vec3& p) const {
    const glm::vec3 share = (log_of(p) - least) / range();
    return {to_steps(share.x, 16), to_steps(share.y, 16), to_steps(share.z, 16)};
  }
  glm::vec3 read_back(const glm::vec3& p) const {
    const glm::vec3 logs = least + glm::vec3(steps_of(p)) / sog::kSteps * range();
    return {sog::from_log(logs.x), sog::from_log(logs.y), sog::from_log(logs.z)};
  }
  // More than the distance of read_back() from p; without logarithms.
  float moves_at_most(const glm::vec3& p) const { return glm::length(moves * (1.0f + glm::abs(p))); }
};

json add_means(const SogInput& in, SogPictures* pictures) {
  const SogMeans means(in.cloud, in.gaussians);
  Image<Rgba8> low = picture_for(in.size()), high = low;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const glm::uvec3 steps = means.steps_of(in.cloud.position[in.gaussians[i]]);
    for (int c = 0; c < 3; ++c) {
      low.pixels()[i][static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(steps[c]);
      high.pixels()[i][static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(steps[c] >> 8);
    }
  }
  pictures->add("means_l", std::move(low));
  pictures->add("means_u", std::move(high));
  return {{"mins", list_of(means.least)},
          {"maxs", list_of(means.most)},
          {"files", {"means_l.webp", "means_u.webp"}}};
}

json add_quats(const SogInput& in, SogPictures* pictures) {
  Image<Rgba8>& image = pictures->add("quats", picture_for(in.size()));
  for (std::size_t i = 0; i < in.size(); ++i) {
    const glm::quat& rotation = in.cloud.rotation[in.gaussians[i]];
    const std::array<float, 4> q{rotation.w, rotation.x, rotation.y, rotation.z};
    const std::uint32_t largest = largest_of(q);
    const float scale = (q[largest] < 0 ? -1.0f : 1.0f) * std::sqrt(2.0f);
    Rgba8& pixel = image.pixels()[i];
    std::size_t next = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (k != largest) pixel[next++] = to_byte((q[k] * scale * 0.5f + 0.5f) * 255);
    pixel[3] = static_cast<std::uint8_t>(sog::kLargestAt + static_cast<int>(largest));
  }
  return {{"files", {"quats.webp"}}};
}

// Three numbers of each Gaussian by a codebook of all of them. value: of a Gaussian.
template <class Value>
Codebook fill_by_codebook(const SogInput& in, const Value& value, Image<Rgba8>* image) {
  std::vector<float> all;
  all.reserve(3 * in.size());
  for (const std::uint32_t g : in.gaussians)
    for (int c = 0; c < 3; ++c) all.push_back(value(g)[c]);
  const Codebook codebook = codebook_of(std::move(all));
  for (std::size_t i = 0; i < in.size(); ++i)
    for (int c = 0; c < 3; ++c)
      image->pixels()[i][static_cast<std::size_t>(c)] = nearest_in(codebook, value(in.gaussians[i])[c]);
  return codebook;
}

json add_scales(const SogInput& in, SogPictures* pictures) {
  Image<Rgba8>& image = pictures->add("scales", picture_for(in.size()));
  const Codebook codebook = fill_by_codebook(
      in, [&](std::uint32_t g) { return glm::log(never_flat(in.cloud.scale[g])); }, &image);
  return {{"codebook", codebook}, {"files", {"scales.webp"}}};
}

json add_sh0(const SogInput& in, SogPictures* pictures) {
  Image<Rgba8>& image = pictures->add("sh0", picture_for(in.size()));
  const Codebook codebook = fill_by_codebook(
      in, [&](std::uint32_t g) { return in.cloud.f_dc[g]; }, &image);
  for (std::size_t i = 0; i < in.size(); ++i)
    image.pixels()[i][3] = to_byte(255 * in.cloud.opacity[in.gaussians[i]]);
  return {{"codebook", codebook}, {"files", {"sh0.webp"}}};
}

Image<Rgba8> centroid_picture(const RowPalette& palette, std::size_t coefficients, const Codebook& codebook) {
  const std::size_t entries = palette.size(3 * coefficients);
  Image<Rgba8> image(static_cast<int>(sog::kCentroidsPerRow * coefficients),
                     static_cast<int>((entries + sog::kCentroidsPerRow - 1) / sog::kCentroidsPerRow),
                     Rgba8{0, 0, 0, 255});
  for (std::size_t e = 0; e < entries; ++e)
    for (std::size_t k = 0; k < coefficients; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        image.pixels()[e * coefficients + k][c] =
            nearest_in(codebook, palette.entries[e * 3 * coefficients + c * coefficients + k]);
  return image;
}

json add_shn(const SogInput& in, SogPictures* pictures) {
  const std::size_t stride = in.cloud.sh_stride();
  std::vector<float> rows;
  rows.reserve(stride * in.size());
  for (const std::uint32_t g : in.gaussians) {
    const std::span<const float> rest = in.cloud.sh_rest_of(g);
    rows.insert(rows.end(), rest.begin(), rest.end());
  }
  const RowPalette palette = palette_of(rows, stride, kMostPalette);
  const Codebook codebook = codebook_of(palette.entries);
  pictures->add("shN_centroids", centroid_picture(palette, stride / 3, codebook));
  Image<Rgba8>& labels = pictures->add("shN_labels", picture_for(in.size()));
  for (std::size_t i = 0; i < in.size(); ++i) {
    const std::uint32_t entry = palette.entry_of[i];
    labels.pixels()[i][0] = static_cast<std::uint8_t>(entry);
    labels.pixels()[i][1] = static_cast<std::uint8_t>(entry >> 8);
  }
  return {{"count", palette.size(stride)},
          {"bands", in.cloud.sh_degree},
          {"codebook", codebook},
          {"files", {"shN_centroids.webp", "shN_labels.webp"}}};
}

json add_all(const SogInput& in, bool antialiased, SogPictures* pictures) {
  json meta = {{"version", 2}, {"asset", {{"generator", "splatcut"}}}, {"count", in.size()}};
  if (antialiased) {  // in the words of the format's text, and of its own converter
    meta["antialias"] = true;
    meta["model"] = "antialiased";
  }
  meta["means"] = add_means(in, pictures);
  meta["scales"] = add_scales(in, pictures);
  meta["quats"] = add_quats(in, pictures);
  meta["sh0"] = add_sh0(in, pictures);
  if (in.cloud.sh_degree > 0) meta["shN"] = add_shn(in, pictures);
  return meta;
}

Losses sog_losses(const Scene& scene, std::span<const std::uint32_t> gaussians) {
  Losses losses;
  losses.add("positions are rounded to 16 bits, rotations and opacities to 8; the Gaussians' order changes");
  losses.add("sizes and colours are each drawn from 256 values");
  if (scene.cloud.sh_degree > 0)
    losses.add(gaussians.size() > kMostPalette
                   ? fmt::format("spherical harmonics of 8 bits are drawn from {} sets", kMostPalette)
                   : "spherical harmonics have 8 bits");
  const SogMeans means(scene.cloud, gaussians);
  losses.add(moved_far(scene.cloud, gaussians, kVisibly, [&](std::size_t i) {
    const glm::vec3 &p = scene.cloud.position[gaussians[i]], &size = scene.cloud.scale[gaussians[i]];
    const bool stays = means.moves_at_most(p) < kVisibly * std::max({size.x, size.y, size.z});
    return stays ? p : means.read_back(p);  // the export dialog waits for it
  }));
  losses.add(origin_left_out(scene));
  losses.add(properties_left_out(scene));
  return losses;
}

}  // namespace

std::string write_sog(AtomicFile& out, const Scene& scene, std::span<const std::uint32_t> gaussians,
                      const SaveOptions& options) {
  SogInput in{scene.cloud, {gaussians.begin(), gaussians.end()}};
  std::ranges::sort(in.gaussians);
  SogPictures pictures;
  json meta = add_all(in, scene.cloud.antialiased, &pictures);
  add_up(options.up, {}, &meta);
  std::vector<ZipEntry> entries(pictures.names.size());
  tbb::parallel_for(std::size_t{0}, entries.size(), [&](std::size_t i) {
    entries[i] = {pictures.names[i], write_webp(pictures.images[i])};
  });
  const std::string text = meta.dump();
  const auto bytes = std::as_bytes(std::span(text));
  entries.push_back({"meta.json", {bytes.begin(), bytes.end()}});
  out.write(zip_of(entries));
  return sog_losses(scene, gaussians).sentence();
}

FormatPlan plan_sog(const Scene& scene, std::span<const std::uint32_t> gaussians, bool) {
  const SogInput sample{scene.cloud, spread_runs(gaussians)};
  SogPictures pictures;
  FormatPlan plan{.about = true,
                  .kept = "What the scene says of Gaussians, quantised and packed for the web.",
                  .lost = sog_losses(scene, gaussians).in_full()};
  if (gaussians.empty()) return plan;
  plan.bytes = add_all(sample, false, &pictures).dump().size();
  for (std::size_t i = 0; i < pictures.names.size(); ++i) {
    const bool of_sets = pictures.names[i].starts_with("shN_centroids");
    plan.bytes += write_webp(pictures.images[i]).size() *
                  std::min(gaussians.size(), of_sets ? kMostPalette : gaussians.size()) / sample.size();
  }
  return plan;
}

}  // namespace splatcut
