#include "scene/cloud/morton.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/large_array.h"
#include "core/radix_sort.h"
#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

namespace {

constexpr int kBitsPerAxis = 21;

// Spreads the low 21 bits of v so that two zero bits follow each.
std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}

using Item = KeyValue<std::uint64_t>;
using Items = LargeArray<Item>;

// The first sorting step splits by the leading bits, so that each part fits a cache and has a thread of its
// own.
constexpr int kLeadingBits = 12;
constexpr int kShift = 3 * kBitsPerAxis - kLeadingBits;
constexpr std::size_t kParts = std::size_t{1} << kLeadingBits;
constexpr std::size_t kRun = 1 << 16;  // items a thread takes at a time
using PartCounts = std::array<std::uint32_t, kParts>;

// f(begin, end, run) for runs of items, on many threads.
template <class Function>
void for_runs(std::size_t count, const Job& job, const Function& f) {
  tbb::parallel_for(std::size_t{0}, (count + kRun - 1) / kRun, [&](std::size_t run) {
    if (!job.cancelled()) f(run * kRun, std::min(count, (run + 1) * kRun), run);
  });
}

// Turns the counts of each run into the places of its items: part by part, and within a part run by run.
// Returns where each part begins, and the end of the last.
std::vector<std::uint32_t> assign_places(std::vector<PartCounts>* counts) {
  std::vector<std::uint32_t> begin(kParts + 1);
  std::uint32_t sum = 0;
  for (std::size_t part = 0; part < kParts; ++part) {
    begin[part] = sum;
    for (PartCounts& count : *counts) sum += std::exchange(count[part], sum);
  }
  begin[kParts] = sum;
  return begin;
}

// Sorts a part, whose leading bits agree: two digits tell nearly all items apart, comparisons do the rest.
void sort_part(std::span<Item> items, std::span<Item> scratch) {
  constexpr int kDigit = 8, kRestBits = kShift - 2 * kDigit;
  radix_sort<kDigit>(items, scratch, kRestBits, kShift);
  for (auto begin = items.begin(); begin != items.end();) {
    const auto end = std::find_if(begin, items.end(), [&](const Item& item) {
      return item.key >> kRestBits != begin->key >> kRestBits;
    });
    if (end - begin > 1)
      std::sort(begin, end, [](const Item& a, const Item& b) {
        return a.key != b.key ? a.key < b.key : a.value < b.value;
      });
    begin = end;
  }
}

// Sorts by key, ties by value, which is ascending. items end sorted; scratch has their number.
void sort_items(Items* items, Items* scratch, const Job& job) {
  const std::size_t n = items->size();
  std::vector<PartCounts> counts((n + kRun - 1) / kRun);
  for_runs(n, job, [&](std::size_t begin, std::size_t end, std::size_t run) {
    for (std::size_t i = begin; i < end; ++i) ++counts[run][(*items)[i].key >> kShift];
  });
  if (job.cancelled()) return;
  const std::vector<std::uint32_t> part_begin = assign_places(&counts);
  for_runs(n, job, [&](std::size_t begin, std::size_t end, std::size_t run) {
    for (std::size_t i = begin; i < end; ++i)
      (*scratch)[counts[run][(*items)[i].key >> kShift]++] = (*items)[i];
  });
  std::swap(*items, *scratch);
  tbb::parallel_for(std::size_t{0}, kParts, [&](std::size_t part) {
    if (job.cancelled()) return;
    const std::size_t begin = part_begin[part], count = part_begin[part + 1] - begin;
    sort_part(std::span(items->data() + begin, count), std::span(scratch->data() + begin, count));
  });
}

}  // namespace

std::vector<std::uint32_t> morton_order(std::span<const glm::vec3> positions, const Job& job) {
  const Box box = robust_bounds(positions);
  constexpr float kCells = 1 << kBitsPerAxis;
  const glm::vec3 cells_per_unit = kCells / glm::max(box.extent(), glm::vec3(1e-20f));
  Items items(positions.size()), scratch(positions.size());
  for_runs(positions.size(), job, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3 cell = glm::clamp((positions[i] - box.min) * cells_per_unit, 0.0f, kCells - 1);
      const auto spread = [](float v) { return spread_bits(static_cast<std::uint64_t>(v)); };
      items[i] = {spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2, static_cast<std::uint32_t>(i)};
    }
  });
  sort_items(&items, &scratch, job);
  std::vector<std::uint32_t> order(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = items[i].value;
  return order;
}

}  // namespace splatcut
