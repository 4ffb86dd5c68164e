// Arrays of plain values without initial content, in large pages where the system has them: the first touch
// of 4 kB pages costs more than most loops over them.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace splatcut {

inline constexpr std::size_t kLargePageBytes = std::size_t{1} << 21;

// Asks for large pages in [data, data + bytes). Only advice: without them everything works, slower.
void advise_large_pages(void* data, std::size_t bytes);

// Takes the memory of [data, data + bytes) from the system now, on all threads, in place of one by one at the
// first write. The bytes may be overwritten with zeros. For memory that advise_large_pages() was called for.
void touch_large_pages(void* data, std::size_t bytes);

template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  LargeArray() = default;
  // Throws std::bad_alloc.
  explicit LargeArray(std::size_t n) : data_(allocate(n * sizeof(T))), size_(n) {}

  std::size_t size() const { return size_; }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }

 private:
  struct Release {
    std::align_val_t alignment;
    void operator()(T* data) const { ::operator delete(data, alignment); }
  };
  using Pointer = std::unique_ptr<T, Release>;

  static Pointer allocate(std::size_t bytes) {
    constexpr std::size_t kCacheLineBytes = 64;
    const std::align_val_t alignment{bytes < kLargePageBytes ? kCacheLineBytes : kLargePageBytes};
    Pointer data(static_cast<T*>(::operator new(bytes, alignment)), Release{alignment});
    advise_large_pages(data.get(), bytes);
    return data;
  }

  Pointer data_;
  std::size_t size_ = 0;
};

}  // namespace splatcut
