#include "app/window/printed_key.h"

namespace splatcut {

int key_meant(int code, std::string_view printed) {
  constexpr int kFirstPrinted = '\'', kLastPrinted = 162;  // GLFW_KEY_APOSTROPHE to GLFW_KEY_WORLD_2
  if (code < kFirstPrinted || code > kLastPrinted || printed.size() != 1) return code;
  if (code >= '0' && code <= '9') return code;
  const char sign = printed.front();
  if (sign >= 'a' && sign <= 'z') return sign - 'a' + 'A';
  if (sign == '+') return '=';  // the key of "+", as the table of keys has it
  return std::string_view("-=[],/").find(sign) != std::string_view::npos ? sign : code;
}

}  // namespace splatcut
