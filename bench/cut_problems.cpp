#include "cut_problems.h"

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "bench_scenes.h"
#include "scene/formats/scene_file.h"
#include "segment/graphcut/energy.h"
#include "segment/graphcut/knn_graph.h"
#include "segment/graphcut/likelihood.h"
#include "segment/masks/mask_tools.h"
#include "segment/superpoints/orbit.h"
#include "still_life_mug.h"

namespace splatcut::bench {

namespace {

constexpr int kWidthPx = 400;

// Up to 4 px too large or too small and, in each third view, a piece bitten off.
Mask noisy(const Mask& truth, std::mt19937& random) {
  const int grow_px = static_cast<int>(random() % 7) - 2;
  Mask mask = grow_px >= 0 ? dilated(truth, grow_px) : eroded(truth, -grow_px);
  if (random() % 3 != 0) return mask;
  const PixelRect box = bounds(mask);
  const int x = box.x0 + static_cast<int>(random() % std::max(1u, static_cast<unsigned>(box.x1 - box.x0)));
  const int y = box.y0 + static_cast<int>(random() % std::max(1u, static_cast<unsigned>(box.y1 - box.y0)));
  const int reach = std::max(1, (box.x1 - box.x0) / 8);
  for (int v = std::max(0, y - reach); v < std::min(mask.height(), y + reach); ++v)
    for (int u = std::max(0, x - reach); u < std::min(mask.width(), x + reach); ++u) mask.at(u, v) = 0;
  return mask;
}

CutProblem problem_from(std::string name, const GaussianCloud& cloud, std::vector<std::uint8_t> truth,
                        const std::vector<Camera>& views) {
  std::mt19937 random(11);
  CutProblem problem;
  const double pixels = static_cast<double>(views.front().width_px) * views.front().height_px;
  MaskedSums sums(cloud.size());
  const auto net = [&](std::size_t seen) {
    return terminals(cloud, likelihood(sums), static_cast<int>(seen), pixels, {}).net;
  };
  for (const Camera& view : views) {
    if (&view == &views.back()) problem.terminal_before = net(views.size() - 1);
    const Mask mask = noisy(thresholded(render_labels(cloud, view, truth), 0.5f), random);
    testing::add_masked_view(cloud, view, mask, sums);
  }
  problem.name = std::move(name);
  problem.graph = knn_graph(cloud);
  problem.capacity = arc_capacities(cloud, problem.graph, {});
  problem.terminal = net(views.size());
  problem.position = cloud.position;
  problem.truth = std::move(truth);
  return problem;
}

std::vector<Camera> views_around(const GaussianCloud& cloud, const std::vector<std::uint8_t>& truth,
                                 const Camera& reference, const glm::vec3& up_world) {
  const Camera small = limited_to_width(reference, kWidthPx);
  std::vector<Camera> views = orbit_cameras(small, up_world, object_extent(cloud, truth), {});
  views.push_back(small);
  return views;
}

glm::vec3 vec3_of(const nlohmann::json& j) {
  return {j[0].get<float>(), j[1].get<float>(), j[2].get<float>()};
}

CutProblem problem_of(const nlohmann::json& entry, const std::filesystem::path& folder) {
  const Scene scene = load_scene(folder / entry.at("scene").get<std::string>());
  std::ifstream file(folder / entry.at("truth").at("labels").get<std::string>(), std::ios::binary);
  const std::vector<char> rows{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::uint8_t> truth;
  for (const std::uint32_t row : scene.cloud.file_row) truth.push_back(rows.at(row) == 1);
  const auto& r = entry.at("reference");
  const Camera reference =
      look_at(vec3_of(r.at("position")), vec3_of(r.at("target")), vec3_of(r.at("up")),
              glm::radians(r.at("fov_y_deg").get<float>()), r.at("size")[0], r.at("size")[1]);
  const std::vector<Camera> views = views_around(scene.cloud, truth, reference, vec3_of(r.at("up")));
  return problem_from(entry.at("name"), scene.cloud, std::move(truth), views);
}

}  // namespace

const CutProblem& still_life_problem(std::size_t gaussians) {
  static std::map<std::size_t, CutProblem> problems;
  const auto it = problems.find(gaussians);
  if (it != problems.end()) return it->second;
  const BenchScene& scene = still_life(gaussians);
  const std::vector<Camera> views = views_around(scene.cloud, scene.mug, scene.cameras.front(), {0, -1, 0});
  return problems[gaussians] = problem_from("still_life_" + std::to_string(gaussians / 1000) + "k",
                                            scene.cloud, scene.mug, views);
}

CutProblem with_twice_the_background(const CutProblem& p) {
  const auto n = static_cast<std::uint32_t>(p.graph.nodes());
  CutProblem out;
  out.name = p.name + "_twice_the_background";
  out.terminal = p.terminal;
  std::vector<std::uint32_t> copy(n, 0);
  for (std::uint32_t v = 0; v < n; ++v) {
    if (p.truth[v]) continue;
    copy[v] = static_cast<std::uint32_t>(out.terminal.size());
    out.terminal.push_back(std::min<std::int64_t>(p.terminal[v], 0));
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::vector<std::int32_t> weight;
  for (const bool again : {false, true})
    for (std::uint32_t v = 0; v < n; ++v)
      for (std::uint32_t arc = p.graph.first_arc[v]; arc < p.graph.first_arc[v + 1]; ++arc) {
        const std::uint32_t other = p.graph.head[arc];
        if (other < v || (again && (p.truth[v] || p.truth[other]))) continue;
        edges.emplace_back(again ? copy[v] : v, again ? copy[other] : other);
        weight.push_back(p.capacity[arc]);
      }
  std::vector<std::uint32_t> arc_of_edge;
  out.graph = graph_from_edges(out.terminal.size(), edges, &arc_of_edge);
  out.capacity.resize(out.graph.arcs());
  for (std::size_t e = 0; e < edges.size(); ++e)
    out.capacity[arc_of_edge[e]] = out.capacity[out.graph.reverse_arc[arc_of_edge[e]]] = weight[e];
  return out;
}

std::vector<CutProblem> suite_problems(const std::filesystem::path& suite) {
  std::ifstream file(suite);
  std::vector<CutProblem> problems;
  const nlohmann::json entries = nlohmann::json::parse(file).at("scenes");
  for (const auto& entry : entries)
    if (entry.at("truth").contains("labels")) problems.push_back(problem_of(entry, suite.parent_path()));
  return problems;
}

}  // namespace splatcut::bench
