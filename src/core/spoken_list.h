// Words as a sentence lists them.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace splatcut {

// "a, b or c". conjunction: "or", "and".
inline std::string spoken_list(std::span<const std::string> words, std::string_view conjunction = "or") {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " " + std::string(conjunction) + " " : ", ";
    text += words[i];
  }
  return text;
}

// Adds a sentence, or none, to a text that ends without a full stop.
inline void add_sentence(std::string_view sentence, std::string* text) {
  if (sentence.empty()) return;
  if (!text->empty()) *text += ". ";
  *text += sentence;
}

}  // namespace splatcut
