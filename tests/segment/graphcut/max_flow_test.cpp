#include "segment/graphcut/max_flow.h"

#include <doctest/doctest.h>

#include <deque>

#include "flow_problems.h"
#include "quick.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

std::vector<std::uint8_t> bits(std::uint32_t set, std::size_t nodes) {
  std::vector<std::uint8_t> side(nodes);
  for (std::size_t n = 0; n < nodes; ++n) side[n] = set >> n & 1;
  return side;
}

// A solver that was just made and holds the problem.
MaxFlow cold(const FlowProblem& p) {
  MaxFlow max_flow(p.graph, p.capacity);
  max_flow.set_terminals(p.terminal);
  return max_flow;
}

// Solves and compares with a cold start: same energy and labels, and the proof holds.
void check_as_cold(MaxFlow& warm, const FlowProblem& p) {
  REQUIRE(warm.solve());
  const MinCutReport expected = min_cut(p.graph, p.capacity, p.terminal);
  REQUIRE(warm.flow() == expected.flow);
  REQUIRE(warm.energy() == expected.flow);
  REQUIRE(warm.source_set() == expected.source_side);
  REQUIRE(warm.certified());
}

void change_terminals(std::mt19937& random, int count, int range, FlowProblem& p, MaxFlow& max_flow) {
  for (int i = 0; i < count; ++i) {
    const auto node = static_cast<std::uint32_t>(random() % p.graph.nodes());
    p.terminal[node] = static_cast<std::int64_t>(random() % static_cast<unsigned>(2 * range)) - range;
    max_flow.set_terminal(node, p.terminal[node]);
  }
}

}  // namespace

TEST_CASE("min_cut finds the least energy, and its smallest source set, of all cuts of 1000 small graphs") {
  std::mt19937 random(5);
  for (int trial = 0; trial < 1000; ++trial) {
    CAPTURE(trial);
    const auto nodes =
        static_cast<std::uint32_t>(2 + random() % (trial % 20 == 0 ? 13 : 9));  // 2^14 cuts are slow to list
    const FlowProblem p =
        random_problem(random, nodes, random() % (3 * nodes), 1 + static_cast<int>(random() % 12));
    const BruteForceCut best = brute_force(p);
    const MinCutReport report = min_cut(p.graph, p.capacity, p.terminal);
    REQUIRE(report.energy == best.energy);
    REQUIRE(report.flow == best.energy);
    REQUIRE(report.source_side == bits(best.source_set, nodes));
  }
}

TEST_CASE("min_cut has the flow of Boost's solver on 110 graphs of up to 200,000 nodes") {
  std::mt19937 random(9);
  std::vector<FlowProblem> problems;
  for (int i = 0; i < 50; ++i)
    problems.push_back(
        random_problem(random, 200 + static_cast<std::uint32_t>(random() % 1000), 2500, 1 + 1000 * (i % 2)));
  for (std::uint32_t i = 0; i < 57; ++i)
    problems.push_back(grid_problem(random, 20 + i, 30, static_cast<int>(i) % 40));
  problems.push_back(random_problem(random, 30000, 120000, 1000));
  problems.push_back(grid_problem(random, 200, 200, 20));
  problems.push_back(grid_problem(random, 500, 400, 5));
  REQUIRE(problems.back().graph.nodes() == 200000);
  for (std::size_t i = 0; i < problems.size(); ++i) {
    CAPTURE(i);
    MaxFlow max_flow = cold(problems[i]);
    REQUIRE(max_flow.solve());
    REQUIRE(max_flow.flow() == boost_flow(problems[i]));
    REQUIRE(max_flow.energy() == max_flow.flow());
    REQUIRE(max_flow.certified());
  }
}

TEST_CASE("a path of three nodes, by hand") {
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> edges = {{0, 1}, {1, 2}};
  const FlowGraph graph = graph_from_edges(3, edges);
  std::vector<std::int32_t> capacity(4, 0);
  capacity[graph.first_arc[0]] = 5;      // 0 -> 1
  capacity[graph.first_arc[1] + 1] = 3;  // 1 -> 2
  const std::vector<std::int64_t> terminal = {10, 0, -10};
  const MinCutReport report = min_cut(graph, capacity, terminal, 7);
  CHECK(report.flow == 7 + 3 + 0);
  CHECK(report.source_side == std::vector<std::uint8_t>{1, 1, 0});
}

TEST_CASE("after each of 1000 changes of one graph the warm solve is the cold one") {
  std::mt19937 random(31);
  FlowProblem p = grid_problem(random, 40, 40, 15);
  MaxFlow max_flow = cold(p);
  check_as_cold(max_flow, p);
  constexpr int kRange = 1000;
  for (int change = 0; change < 1000; ++change) {
    CAPTURE(change);
    change_terminals(random, 1 + static_cast<int>(random() % (change % 50 == 0 ? 800 : 12)), kRange, p,
                     max_flow);
    check_as_cold(max_flow, p);
  }
  CHECK(max_flow.cold_starts() < 20);
}

TEST_CASE("a change of everything at once is exact, warm or by the cold start that it may end in") {
  std::mt19937 random(38);
  FlowProblem p = grid_problem(random, 250, 250, 10);
  MaxFlow max_flow = cold(p);
  check_as_cold(max_flow, p);
  for (const std::uint32_t shift : {1u, 100u, 20000u}) {
    std::ranges::rotate(p.terminal, p.terminal.begin() + shift);
    for (std::int64_t& b : p.terminal) b = shift == 100 ? -b : b;
    max_flow.set_terminals(p.terminal);
    check_as_cold(max_flow, p);
  }
}

QUICK_CASE("max flow", "small ranges, where ties and zeros are common: 1000 changes against brute force") {
  std::mt19937 random(32);
  for (int graph = 0; graph < 50; ++graph) {
    FlowProblem p = random_problem(random, 8, random() % 20, 1 + graph % 4);
    MaxFlow max_flow = cold(p);
    for (int change = 0; change < 20; ++change) {
      change_terminals(random, 1 + static_cast<int>(random() % 4), 1 + graph % 4, p, max_flow);
      REQUIRE(max_flow.solve());
      const BruteForceCut best = brute_force(p);
      REQUIRE(max_flow.flow() == best.energy);
      REQUIRE(max_flow.source_set() == bits(best.source_set, 8));
    }
  }
}

TEST_CASE("other capacities, higher or lower: the flow is kept as far as it fits, and the solve is exact") {
  std::mt19937 random(33);
  FlowProblem p = grid_problem(random, 30, 30, 20);
  const std::vector<std::int32_t> first = p.capacity;
  std::deque<std::vector<std::int32_t>> kept = {first};  // what the solver looks at must stay
  MaxFlow max_flow(p.graph, kept.back());
  max_flow.set_terminals(p.terminal);
  check_as_cold(max_flow, p);
  for (const int percent : {130, 150, 400, 90, 10, 300, 0, 100}) {
    CAPTURE(percent);
    kept.push_back(first);
    for (std::int32_t& c : kept.back()) c = c * percent / 100;
    p.capacity = kept.back();
    const std::size_t cold_starts = max_flow.cold_starts();
    max_flow.set_capacity(kept.back());
    check_as_cold(max_flow, p);
    CHECK(max_flow.cold_starts() == cold_starts);
    change_terminals(random, 20, 1000, p, max_flow);
    check_as_cold(max_flow, p);
  }
}

TEST_CASE("other capacities, arc by arc at random, against brute force") {
  std::mt19937 random(39);
  for (int graph = 0; graph < 100; ++graph) {
    FlowProblem p = random_problem(random, 8, 4 + random() % 20, 1 + graph % 6);
    std::deque<std::vector<std::int32_t>> kept = {p.capacity};
    MaxFlow max_flow(p.graph, kept.back());
    max_flow.set_terminals(p.terminal);
    for (int change = 0; change < 10; ++change) {
      REQUIRE(max_flow.solve());
      const BruteForceCut best = brute_force(p);
      REQUIRE(max_flow.flow() == best.energy);
      REQUIRE(max_flow.energy() == best.energy);
      REQUIRE(max_flow.source_set() == bits(best.source_set, 8));
      for (std::int32_t& c : p.capacity)
        c = static_cast<std::int32_t>(random() % static_cast<unsigned>(1 + graph % 6));
      kept.push_back(p.capacity);
      max_flow.set_capacity(kept.back());
      change_terminals(random, static_cast<int>(random() % 3), 1 + graph % 6, p, max_flow);
    }
  }
}

TEST_CASE("other capacities: more flow taken back than a node can hold ends in a cold start, and is exact") {
  // Four sources -> node 0 -> four sinks, all of the largest size; then nothing may leave node 0.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t n = 1; n <= 8; ++n) edges.emplace_back(0, n);
  FlowProblem p{graph_from_edges(9, edges), {}, {}};
  p.capacity.assign(p.graph.arcs(), (1 << 30) - 1);
  p.terminal.assign(9, -MaxFlow::kLargestTerminal);
  for (std::size_t n = 1; n <= 4; ++n) p.terminal[n] = MaxFlow::kLargestTerminal;
  p.terminal[0] = 0;
  const std::vector<std::int32_t> wide = p.capacity;  // what the solver looks at must stay
  MaxFlow max_flow(p.graph, wide);
  max_flow.set_terminals(p.terminal);
  check_as_cold(max_flow, p);
  CHECK(max_flow.flow() == 4 * MaxFlow::kLargestTerminal);
  for (std::uint32_t arc = p.graph.first_arc[0]; arc < p.graph.first_arc[1]; ++arc) p.capacity[arc] = 0;
  max_flow.set_capacity(p.capacity);
  check_as_cold(max_flow, p);
  CHECK(max_flow.flow() == 0);
  CHECK(max_flow.cold_starts() == 2);
}

TEST_CASE("a warm solve that works far beyond what a cold one did gives up for a cold start, and is exact") {
  std::mt19937 random(40);
  FlowProblem noisy = grid_problem(random, 300, 300, 30), p = noisy;
  for (std::int64_t& b : p.terminal) b = -1;
  p.terminal[45150] = 5;
  MaxFlow max_flow = cold(p);
  check_as_cold(max_flow, p);  // a handful of nodes
  CHECK(max_flow.touched() < 100);
  p.terminal = noisy.terminal;
  max_flow.set_terminals(p.terminal);
  check_as_cold(max_flow, p);
  CHECK(max_flow.cold_starts() == 2);
  change_terminals(random, 10, 1000, p, max_flow);
  check_as_cold(max_flow, p);
  CHECK(max_flow.cold_starts() == 2);  // what counts from now on is that cold start's work
}

QUICK_CASE("max flow", "restart forgets the flow, not the problem, a cancelled solve can be taken up again") {
  std::mt19937 random(35);
  const FlowProblem p = grid_problem(random, 200, 200, 10);
  MaxFlow max_flow = cold(p);
  std::stop_source stop;
  stop.request_stop();
  Job job;
  job.stop = stop.get_token();
  CHECK_FALSE(max_flow.solve(job));
  check_as_cold(max_flow, p);
  max_flow.restart();
  check_as_cold(max_flow, p);
}

TEST_CASE("the solve stays near the object: background that nothing pulls on is not touched") {
  std::mt19937 random(37);
  std::vector<std::size_t> touched;
  for (const std::uint32_t width : {100u, 200u, 400u}) {
    FlowProblem p = grid_problem(random, width, 100, 0);
    for (std::uint32_t n = 0; n < p.graph.nodes(); ++n) {
      const std::uint32_t x = n % width, y = n / width;
      p.terminal[n] = x >= 20 && x < 50 && y >= 30 && y < 60 ? 800 : -100;
    }
    MaxFlow max_flow = cold(p);
    check_as_cold(max_flow, p);
    touched.push_back(max_flow.touched());
  }
  CHECK(touched[0] < 3000);
  CHECK(touched[1] < 1.2 * static_cast<double>(touched[0]));
  CHECK(touched[2] < 1.2 * static_cast<double>(touched[0]));
}
