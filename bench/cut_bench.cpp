// The exact cut, cold and warm, beside Boost and OpenCV on the same problems. Times are CPU milliseconds of
// the one thread that solves, with building of the solver's own graph, and without loading, k-NN and
// capacities.
#include "cut_bench.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <random>
#include <stdexcept>

#include "cpu_clock.h"
#include "cut_problems.h"
#include "other_solvers.h"

namespace splatcut::bench {

namespace {

template <class Work>
void timed(benchmark::State& state, const Work& work) {
  const double start = cpu_seconds();
  work();
  state.SetIterationTime(cpu_seconds() - start);
}

std::int64_t expected_flow(const CutProblem& p) {
  return min_cut(p.graph, p.capacity, p.terminal).flow;
}

void demand(bool right) {
  if (!right) throw std::logic_error("the solvers disagree");
}

using ProblemOf = std::function<const CutProblem&()>;

void cut_cold(benchmark::State& state, const ProblemOf& problem_of) {
  const CutProblem& p = problem_of();
  std::size_t touched = 0;
  for (auto _ : state)
    timed(state, [&] {
      MaxFlow max_flow(p.graph, p.capacity);
      max_flow.set_terminals(p.terminal);
      max_flow.solve();
      touched = max_flow.touched();
    });
  state.counters["nodes"] = static_cast<double>(p.graph.nodes());
  state.counters["arcs"] = static_cast<double>(p.graph.arcs());
  state.counters["touched"] = static_cast<double>(touched);
}

// As cold, on a solver that stands ready, as it does after loading.
void cut_in_place(benchmark::State& state, const ProblemOf& problem_of) {
  const CutProblem& p = problem_of();
  MaxFlow max_flow(p.graph, p.capacity);
  const std::vector<std::int64_t> nothing(p.graph.nodes(), 0);
  for (auto _ : state) {
    max_flow.set_terminals(nothing);
    max_flow.restart();
    max_flow.solve();
    timed(state, [&] {
      max_flow.set_terminals(p.terminal);
      max_flow.solve();
    });
  }
  demand(max_flow.flow() == expected_flow(p));
  const double bytes =
      4.0 * static_cast<double>(p.graph.nodes() + 1) + 12.0 * static_cast<double>(p.graph.arcs()) +
      17.0 * static_cast<double>(p.graph.nodes()) + 4.0 * static_cast<double>(p.graph.arcs());
  state.counters["bytes_per_node"] = bytes / static_cast<double>(p.graph.nodes());
}

void cut_other(benchmark::State& state, const ProblemOf& problem_of,
               std::int64_t (*solve)(const CutProblem&)) {
  const CutProblem& p = problem_of();
  std::int64_t flow = 0;
  for (auto _ : state) timed(state, [&] { flow = solve(p); });
  demand(flow == expected_flow(p));
}

// The view after the last: all terminals change, most of them a little.
void cut_next_view(benchmark::State& state, const ProblemOf& problem_of) {
  const CutProblem& p = problem_of();
  MaxFlow max_flow(p.graph, p.capacity);
  std::size_t cold = 0;
  for (auto _ : state) {
    max_flow.set_terminals(p.terminal_before);
    max_flow.restart();
    max_flow.solve();
    const std::size_t before = max_flow.cold_starts();
    timed(state, [&] {
      max_flow.set_terminals(p.terminal);
      max_flow.solve();
    });
    cold += max_flow.cold_starts() - before;
  }
  demand(max_flow.flow() == expected_flow(p));
  state.counters["cold_starts"] = static_cast<double>(cold) / static_cast<double>(state.iterations());
}

// Strokes: the nodes nearest to a node on the object's border.
std::vector<std::vector<std::uint32_t>> strokes_on(const CutProblem& p, std::size_t nodes) {
  std::vector<std::uint32_t> border;
  for (std::uint32_t v = 0; v < p.graph.nodes(); ++v)
    for (std::uint32_t arc = p.graph.first_arc[v]; arc < p.graph.first_arc[v + 1]; ++arc)
      if (p.truth[v] && !p.truth[p.graph.head[arc]]) border.push_back(v);
  std::mt19937 random(21);
  std::vector<std::vector<std::uint32_t>> strokes(10);
  std::vector<std::uint32_t> all(p.graph.nodes());
  for (auto& stroke : strokes) {
    const glm::vec3 centre = p.position[border[random() % border.size()]];
    for (std::uint32_t v = 0; v < all.size(); ++v) all[v] = v;
    const auto distance2 = [&](std::uint32_t v) {
      return glm::dot(p.position[v] - centre, p.position[v] - centre);
    };
    const auto end = all.begin() + static_cast<std::ptrdiff_t>(std::min(nodes, all.size()));
    std::ranges::nth_element(all, end, {}, distance2);
    stroke.assign(all.begin(), end);
  }
  return strokes;
}

// The nodes of a stroke are all meant as the object, or all as the rest; undone between the iterations.
void cut_after_stroke(benchmark::State& state, const ProblemOf& problem_of, std::int64_t b) {
  const CutProblem& p = problem_of();
  MaxFlow max_flow(p.graph, p.capacity);
  max_flow.set_terminals(p.terminal);
  max_flow.solve();
  const auto strokes = strokes_on(p, static_cast<std::size_t>(state.range(0)));
  std::size_t i = 0, changed = 0, cold = 0;
  for (auto _ : state) {
    const auto& stroke = strokes[i++ % strokes.size()];
    const std::vector<std::uint8_t> labels = max_flow.source_set();
    const std::size_t before = max_flow.cold_starts();
    timed(state, [&] {
      for (const std::uint32_t v : stroke) max_flow.set_terminal(v, b);
      max_flow.solve();
    });
    cold += max_flow.cold_starts() - before;
    const std::vector<std::uint8_t> after = max_flow.source_set();
    for (std::size_t v = 0; v < after.size(); ++v) changed += labels[v] != after[v];
    for (const std::uint32_t v : stroke) max_flow.set_terminal(v, p.terminal[v]);
    max_flow.solve();
  }
  demand(max_flow.flow() == expected_flow(p));
  state.counters["changed"] = static_cast<double>(changed) / static_cast<double>(state.iterations());
  state.counters["cold_starts"] = static_cast<double>(cold) / static_cast<double>(state.iterations());
}

std::vector<std::int32_t> scaled_capacity(const CutProblem& p, double lambda) {
  std::vector<std::int32_t> scaled;
  for (const std::int32_t c : p.capacity) scaled.push_back(static_cast<std::int32_t>(c * lambda));
  return scaled;
}

// lambda from a quarter to 16 in 12 steps, rising or falling: the sum, each step from the one before or from
// nothing.
void lambda_sweep(benchmark::State& state, const ProblemOf& problem_of, bool rising, bool warm) {
  const CutProblem& p = problem_of();
  std::vector<std::vector<std::int32_t>> capacities;
  for (int step = 0; step <= 12; ++step)
    capacities.push_back(scaled_capacity(p, 0.25 * std::exp2(step / 2.0)));
  if (!rising) std::ranges::reverse(capacities);
  std::size_t cold = 0;
  for (auto _ : state) {
    MaxFlow max_flow(p.graph, capacities.front());
    max_flow.set_terminals(p.terminal);
    max_flow.solve();
    timed(state, [&] {
      for (std::size_t step = 1; step < capacities.size(); ++step) {
        max_flow.set_capacity(capacities[step]);
        if (!warm) max_flow.restart();
        max_flow.solve();
      }
    });
    cold = max_flow.cold_starts() - 1;
  }
  state.counters["cold_starts"] = static_cast<double>(cold);
}

benchmark::internal::Benchmark* manual(benchmark::internal::Benchmark* bench) {
  return bench->Unit(benchmark::kMillisecond)->UseManualTime();
}

void register_problem(const std::string& name, const ProblemOf& problem, bool with_others) {
  const auto add = [&](const std::string& what, auto&& run) {
    return manual(benchmark::RegisterBenchmark((what + "/" + name).c_str(), run));
  };
  add("cut_cold", [=](benchmark::State& s) { cut_cold(s, problem); });
  add("cut_in_place", [=](benchmark::State& s) { cut_in_place(s, problem); });
  add("cut_in_place_twice_the_background", [=](benchmark::State& s) {
    const CutProblem doubled = with_twice_the_background(problem());
    cut_in_place(s, [&]() -> const CutProblem& { return doubled; });
  });
  if (with_others) {
    add("boost_boykov_kolmogorov",
        [=](benchmark::State& s) { cut_other(s, problem, boost_boykov_kolmogorov); });
    add("boost_push_relabel", [=](benchmark::State& s) { cut_other(s, problem, boost_push_relabel); });
    add("opencv_gcgraph", [=](benchmark::State& s) { cut_other(s, problem, opencv_gcgraph); });
  }
  add("cut_next_view", [=](benchmark::State& s) { cut_next_view(s, problem); });
  constexpr std::int64_t kMeant = 8 << 20;  // eight times what all views together can say
  add("cut_after_object_stroke", [=](benchmark::State& s) { cut_after_stroke(s, problem, kMeant); })
      ->RangeMultiplier(10)
      ->Range(10, 10000)
      ->Iterations(20);
  add("cut_after_rest_stroke", [=](benchmark::State& s) { cut_after_stroke(s, problem, -kMeant); })
      ->RangeMultiplier(10)
      ->Range(10, 10000)
      ->Iterations(20);
  for (const bool rising : {true, false})
    for (const bool warm : {true, false})
      add(fmt::format("lambda_{}_{}", rising ? "rising" : "falling", warm ? "warm" : "cold"),
          [=](benchmark::State& s) { lambda_sweep(s, problem, rising, warm); });
}

}  // namespace

void register_cut_benchmarks() {
  constexpr std::size_t kOthersUpTo = 1'000'000;  // Boost takes some 120 bytes an arc
  for (const std::size_t n : {200'000, 500'000, 1'000'000, 2'000'000, 5'000'000})
    register_problem(
        fmt::format("still_life_{}k", n / 1000), [n]() -> const CutProblem& { return still_life_problem(n); },
        n <= kOthersUpTo);
  const char* suite = std::getenv("SPLATCUT_BENCH_SUITE");
  if (!suite) return;
  static const std::vector<CutProblem> problems = suite_problems(suite);
  for (const CutProblem& p : problems)
    register_problem(
        p.name, [&p]() -> const CutProblem& { return p; }, true);
}

}  // namespace splatcut::bench
