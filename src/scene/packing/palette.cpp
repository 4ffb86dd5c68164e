#include "scene/packing/palette.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <queue>

namespace splatcut {

namespace {

// Values in rising order and the sums before each, so that mean and error of a run cost nothing.
struct SortedValues {
  std::vector<float> values;
  std::vector<double> sums{0}, squares{0};

  explicit SortedValues(std::vector<float> all) : values(std::move(all)) {
    std::ranges::sort(values);
    for (const double v : values) {
      sums.push_back(sums.back() + v);
      squares.push_back(squares.back() + v * v);
    }
  }
  float mean(std::size_t begin, std::size_t end) const {
    return static_cast<float>((sums[end] - sums[begin]) / static_cast<double>(end - begin));
  }
  double error(std::size_t begin, std::size_t end) const {  // sum of squares around the mean
    const double sum = sums[end] - sums[begin];
    return squares[end] - squares[begin] - sum * sum / static_cast<double>(end - begin);
  }
  std::size_t first_from(float value) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(values, value) - values.begin());
  }
};

Codebook codebook_of_distinct(std::span<const float> distinct) {
  Codebook codebook{};
  for (std::size_t i = 0; i < codebook.size(); ++i)
    codebook[i] = distinct.empty() ? 0 : distinct[std::min(i, distinct.size() - 1)];
  return codebook;
}

// More than 256 values differ. The run of largest error is halved at its mean until there are 256: errors
// that are alike are what the best codebook has.
Codebook first_guess(const SortedValues& sorted) {
  struct Run {
    double error;
    std::size_t begin, end;
    bool operator<(const Run& other) const {
      return error != other.error ? error < other.error : begin > other.begin;
    }
  };
  const auto run = [&](std::size_t begin, std::size_t end) {
    const bool alike = sorted.values[begin] == sorted.values[end - 1];
    return Run{alike ? -1 : std::max(0.0, sorted.error(begin, end)), begin, end};
  };
  std::priority_queue<Run> runs;
  runs.push(run(0, sorted.values.size()));
  while (runs.size() < Codebook{}.size()) {
    const Run largest = runs.top();
    runs.pop();
    std::size_t middle = sorted.first_from(sorted.mean(largest.begin, largest.end));
    if (middle <= largest.begin || middle >= largest.end)  // rounded to an end
      middle = sorted.first_from(sorted.values[largest.end - 1]);
    runs.push(run(largest.begin, middle));
    runs.push(run(middle, largest.end));
  }
  Codebook codebook;
  for (float& entry : codebook) {
    entry = sorted.mean(runs.top().begin, runs.top().end);
    runs.pop();
  }
  std::ranges::sort(codebook);
  return codebook;
}

void improve(const SortedValues& sorted, Codebook* codebook) {
  std::size_t begin = 0;
  Codebook means = *codebook;
  for (std::size_t i = 0; i < codebook->size(); ++i) {
    const bool last = i + 1 == codebook->size();
    const std::size_t end =
        last ? sorted.values.size() : sorted.first_from(0.5f * ((*codebook)[i] + (*codebook)[i + 1]));
    if (end > begin) means[i] = sorted.mean(begin, end);
    begin = std::max(begin, end);
  }
  *codebook = means;
}

// Rows that share an entry so far.
struct Kind {
  std::size_t begin = 0, end = 0;  // in the order of rows
  std::size_t axis = 0;            // of the widest spread
  float at = 0;                    // the mean there
  double error = 0;                // sum of squares around the mean, over all axes

  bool operator<(const Kind& other) const {
    return error != other.error ? error < other.error : begin > other.begin;
  }
};

struct PaletteRows {
  std::span<const float> values;
  std::size_t width;
  std::vector<std::uint32_t> order;

  float value(std::size_t i, std::size_t axis) const { return values[order[i] * width + axis]; }
};

Kind kind_of(const PaletteRows& rows, std::size_t begin, std::size_t end) {
  std::vector<double> sums(rows.width, 0), squares(rows.width, 0);
  for (std::size_t i = begin; i < end; ++i)
    for (std::size_t axis = 0; axis < rows.width; ++axis) {
      const double v = rows.value(i, axis) - rows.value(begin, axis);  // small numbers: no digits are lost
      sums[axis] += v;
      squares[axis] += v * v;
    }
  Kind kind{begin, end, 0, 0, 0};
  double widest = 0;
  const auto n = static_cast<double>(end - begin);
  for (std::size_t axis = 0; axis < rows.width; ++axis) {
    const double error = std::max(0.0, squares[axis] - sums[axis] * sums[axis] / n);
    kind.error += error;
    if (error <= widest) continue;
    widest = error;
    kind.axis = axis;
    kind.at = static_cast<float>(rows.value(begin, axis) + sums[axis] / n);
  }
  return kind;
}

// Where the second half begins; neither half is empty.
std::size_t halve(PaletteRows* rows, const Kind& kind) {
  const auto first = rows->order.begin() + static_cast<std::ptrdiff_t>(kind.begin),
             last = rows->order.begin() + static_cast<std::ptrdiff_t>(kind.end);
  const auto by = [&](std::uint32_t row) { return rows->values[row * rows->width + kind.axis]; };
  auto middle = std::stable_partition(first, last, [&](std::uint32_t row) { return by(row) < kind.at; });
  if (middle == first || middle == last) {  // the mean was rounded to the least or the greatest
    const float least = by(*std::ranges::min_element(first, last, {}, by));
    middle = std::stable_partition(first, last, [&](std::uint32_t row) { return by(row) == least; });
  }
  return kind.begin + static_cast<std::size_t>(middle - first);
}

}  // namespace

Codebook codebook_of(std::vector<float> values) {
  const SortedValues sorted(std::move(values));
  std::vector<float> distinct;
  std::ranges::unique_copy(sorted.values, std::back_inserter(distinct));
  if (distinct.size() <= Codebook{}.size()) return codebook_of_distinct(distinct);
  constexpr int kRounds = 20;  // the error settles within a few
  Codebook codebook = first_guess(sorted);
  for (int round = 0; round < kRounds; ++round) improve(sorted, &codebook);
  return codebook;
}

std::uint8_t nearest_in(const Codebook& codebook, float value) {
  const auto above = std::ranges::lower_bound(codebook, value) - codebook.begin();
  if (above == 0) return 0;
  if (above == static_cast<std::ptrdiff_t>(codebook.size())) return 255;
  const auto i = static_cast<std::size_t>(above);
  return static_cast<std::uint8_t>(value - codebook[i - 1] <= codebook[i] - value ? i - 1 : i);
}

RowPalette palette_of(std::span<const float> values, std::size_t width, std::size_t most) {
  PaletteRows rows{values, width, std::vector<std::uint32_t>(values.size() / width)};
  std::iota(rows.order.begin(), rows.order.end(), 0u);
  std::priority_queue<Kind> kinds;
  std::vector<Kind> done;
  if (!rows.order.empty()) kinds.push(kind_of(rows, 0, rows.order.size()));
  while (!kinds.empty()) {
    const Kind kind = kinds.top();
    kinds.pop();
    if (kind.error <= 0 || done.size() + kinds.size() + 1 >= most) {
      done.push_back(kind);
      continue;
    }
    const std::size_t middle = halve(&rows, kind);
    kinds.push(kind_of(rows, kind.begin, middle));
    kinds.push(kind_of(rows, middle, kind.end));
  }
  RowPalette palette;
  palette.entry_of.resize(rows.order.size());
  for (const Kind& kind : done) {
    const auto entry = static_cast<std::uint32_t>(palette.size(width));
    for (std::size_t i = kind.begin; i < kind.end; ++i) palette.entry_of[rows.order[i]] = entry;
    for (std::size_t axis = 0; axis < width; ++axis) {
      double sum = 0;
      for (std::size_t i = kind.begin; i < kind.end; ++i) sum += rows.value(i, axis);
      palette.entries.push_back(static_cast<float>(sum / static_cast<double>(kind.end - kind.begin)));
    }
  }
  return palette;
}

}  // namespace splatcut
