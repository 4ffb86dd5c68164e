#include "scene/camera/plain_letters.h"

#include <algorithm>
#include <array>

namespace splatcut {

namespace {

// Letters of U+00C0 to U+017F, and of U+1EA0 to U+1EF9; '.' where there is no such letter.
constexpr char32_t kFirstLatin = 0xc0, kFirstVietnamese = 0x1ea0;
constexpr std::string_view kLatin =
    "AAAAAA.CEEEEIIII.NOOOOO..UUUUY..aaaaaa.ceeeeiiii.nooooo..uuuuy.y"
    "AaAaAaCcCcCcCcDd..EeEeEeEeEeGgGgGgGgHh..IiIiIiIiI...JjKk.LlLlLl....NnNnNn...OoOoOo..RrRrRrSsSsSsSsTtTt.."
    "UuUuUuUuUuUuWwYyYZzZzZz.";
constexpr std::string_view kVietnamese =
    "AaAaAaAaAaAaAaAaAaAaAaAaEeEeEeEeEeEeEeEeIiIiOoOoOoOoOoOoOoOoOoOoOoOoUuUuUuUuUuUuUuYyYyYyYy";

struct Pair {
  char32_t letter, plain;
};
constexpr std::array<Pair, 12> kOthers{{{0x0401, 0x0415},  // Cyrillic Ё, Ї, Ў, Й, capital and small
                                        {0x0407, 0x0406},
                                        {0x040e, 0x0423},
                                        {0x0419, 0x0418},
                                        {0x0439, 0x0438},
                                        {0x0451, 0x0435},
                                        {0x0457, 0x0456},
                                        {0x045e, 0x0443},
                                        {0x01a0, 'O'},  // Vietnamese letters with a horn
                                        {0x01a1, 'o'},
                                        {0x01af, 'U'},
                                        {0x01b0, 'u'}}};

bool is_mark(char32_t c) {
  return (c >= 0x300 && c <= 0x36f) || c == 0x3099 || c == 0x309a;
}

// Hiragana and katakana: a voiced letter follows its plain one.
char32_t without_voice(char32_t c) {
  const char32_t k = c >= 0x30a0 ? c - 0x60 : c;
  if ((k >= 0x304c && k <= 0x3062 && k % 2 == 0) || k == 0x3065 || k == 0x3067 || k == 0x3069) return c - 1;
  if (k >= 0x306f && k <= 0x307d) return c - (k - 0x306f) % 3;
  return k == 0x3094 ? c - 0x4e : c;
}

char32_t plain_letter(char32_t c) {
  const auto of = [&](std::string_view letters, char32_t first) {
    return c >= first && c - first < letters.size() && letters[c - first] != '.'
               ? static_cast<char32_t>(letters[c - first])
               : char32_t{0};
  };
  if (const char32_t latin = of(kLatin, kFirstLatin)) return latin;
  if (const char32_t vietnamese = of(kVietnamese, kFirstVietnamese)) return vietnamese;
  if (const auto other = std::ranges::find(kOthers, c, &Pair::letter); other != kOthers.end())
    return other->plain;
  return c >= 0x3040 && c <= 0x30ff ? without_voice(c) : c;
}

void add_utf8(char32_t c, std::string* text) {
  const auto byte = [&](char32_t bits) { *text += static_cast<char>(bits); };
  if (c < 0x80) return byte(c);
  if (c < 0x800) return byte(0xc0 | c >> 6), byte(0x80 | (c & 0x3f));
  byte(0xe0 | c >> 12), byte(0x80 | (c >> 6 & 0x3f)), byte(0x80 | (c & 0x3f));
}

// Unicode's arithmetic: 28 endings of 21 vowels of 19 beginnings.
void add_letter(char32_t c, std::string* text) {
  constexpr char32_t kSyllable = 0xac00, kBegin = 0x1100, kVowel = 0x1161, kEnd = 0x11a7;
  if (c < kSyllable || c >= kSyllable + 19 * 21 * 28) {
    if (!is_mark(c)) add_utf8(plain_letter(c), text);
    return;
  }
  const char32_t s = c - kSyllable;
  add_utf8(kBegin + s / (21 * 28), text);
  add_utf8(kVowel + s / 28 % 21, text);
  if (s % 28 > 0) add_utf8(kEnd + s % 28, text);
}

// Bytes of the character of two or three that begins the text; 0 for others.
std::size_t length_of(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t length = (first & 0xe0) == 0xc0 ? 2 : (first & 0xf0) == 0xe0 ? 3 : 0;
  const auto follows = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
  return text.size() >= length && std::ranges::all_of(text.substr(1, length - (length > 0)), follows) ? length
                                                                                                      : 0;
}

}  // namespace

std::string without_accents(std::string_view name) {
  std::string plain;
  while (!name.empty()) {
    const std::size_t length = length_of(name);
    if (length == 0) {
      plain += name[0];
      name.remove_prefix(1);
      continue;
    }
    char32_t c = static_cast<unsigned char>(name[0]) & (length == 2 ? 0x1f : 0x0f);
    for (std::size_t i = 1; i < length; ++i) c = c << 6 | (static_cast<unsigned char>(name[i]) & 0x3f);
    add_letter(c, &plain);
    name.remove_prefix(length);
  }
  return plain;
}

}  // namespace splatcut
