// Values by key that may be found again: the oldest go first once they are too many, or take too much memory.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <utility>

namespace splatcut {

template <class Value>
class OldestFirst {
 public:
  OldestFirst(std::size_t most, std::size_t most_bytes) : most_(most), most_bytes_(most_bytes) {}

  // Null: it is not known, or no longer. Stands until the next put().
  const Value* find(const std::string& key) const {
    const auto known = values_.find(key);
    return known == values_.end() ? nullptr : &known->second.value;
  }
  // bytes: of the value. The one that is put last stays, however large it is.
  void put(const std::string& key, Value value, std::size_t bytes) {
    const auto [known, fresh] = values_.try_emplace(key);
    if (!fresh) std::erase(ages_, key);
    ages_.push_back(key);
    bytes_ += bytes + (fresh ? 2 * key.size() : 0) - known->second.bytes;
    known->second = {std::move(value), bytes};
    while (ages_.size() > 1 && (ages_.size() > most_ || bytes_ > most_bytes_)) {
      const auto oldest = values_.find(ages_.front());
      bytes_ -= oldest->second.bytes + 2 * oldest->first.size();
      values_.erase(oldest);
      ages_.pop_front();
    }
  }
  std::size_t size() const { return values_.size(); }
  std::size_t bytes() const { return bytes_; }  // of keys and values

 private:
  struct Known {
    Value value{};
    std::size_t bytes = 0;
  };
  std::size_t most_, most_bytes_, bytes_ = 0;
  std::map<std::string, Known> values_;
  std::deque<std::string> ages_;  // keys, the oldest first
};

}  // namespace splatcut
