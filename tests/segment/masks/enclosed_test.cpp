// Hidden pieces of an object.
#include "segment/masks/enclosed.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace splatcut;

TEST_CASE("enclosed: hidden pieces join the object that they touch alone, by hand") {
  // A chain: object 0 1, hidden 2 3, object 4, hidden 5, rest 6, and faint 7 hanging at 3.
  GaussianCloud cloud;
  cloud.resize(8, 0);
  std::ranges::fill(cloud.opacity, 0.9f);
  cloud.opacity[7] = 0.05f;
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> edges = {{0, 1}, {1, 2}, {2, 3}, {3, 4},
                                                                      {4, 5}, {5, 6}, {3, 7}};
  const FlowGraph graph = graph_from_edges(8, edges);
  using Labels = std::vector<std::uint8_t>;
  const Labels shown = {1, 1, 0, 0, 1, 0, 1, 0}, before = {1, 1, 0, 0, 1, 0, 0, 0};
  EnclosedOptions options;
  options.most_size = 1;
  Labels labels = before;
  CHECK(join_enclosed(cloud, graph, shown, options, &labels) == 2);
  CHECK(labels == Labels{1, 1, 1, 1, 1, 0, 0, 0});  // 5 touches the rest as well
  labels = before;
  options.most_size = 0.5f;  // a piece of two is too much beside an object of three
  CHECK(join_enclosed(cloud, graph, shown, options, &labels) == 0);
  CHECK(labels == before);
  options.most_size = 1;
  options.least_object = 0.5f;
  CHECK(join_enclosed(cloud, graph, shown, options, &labels) == 3);
  // What the view shows stays as the user sees it.
  const Labels all_shown(8, 1);
  labels = before;
  CHECK(join_enclosed(cloud, graph, all_shown, {}, &labels) == 0);
  CHECK(labels == before);
}
