// Loops over all elements on all cores, in chunks of fixed size. For .cpp files:
// no header may include what reads TBB.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace splatcut {

// work(from, to) for pieces of 0..n-1.
template <class Work>
void for_chunks(std::size_t n, const Work& work) {
  constexpr std::size_t kChunk = 4096;
  tbb::parallel_for(std::size_t{0}, (n + kChunk - 1) / kChunk,
                    [&](std::size_t c) { work(c * kChunk, std::min(n, (c + 1) * kChunk)); });
}

// work(i) for each i of 0..n-1.
template <class Work>
void for_each_index(std::size_t n, const Work& work) {
  for_chunks(n, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) work(i);
  });
}

}  // namespace splatcut
