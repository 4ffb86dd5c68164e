// Keys of keyboards that are not American ones.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "app/tools/actions.h"
#include "app/window/printed_key.h"

using namespace splatcut;

namespace {

struct PrintedKey {
  int code;             // by its place on an American keyboard
  const char* printed;  // without Shift
  int meant;
};
struct Layout {
  const char* name;
  std::vector<PrintedKey> keys;
};

const std::vector<Layout> kLayouts = {
    {"American", {{'=', "=", '='}, {'-', "-", '-'}, {'/', "/", '/'}, {'[', "[", '['}, {'A', "a", 'A'}}},
    {"Swedish", {{'-', "+", '='}, {'/', "-", '-'}, {',', ",", ','}, {'[', "å", '['}, {'=', "´", '='}}},
    {"Norwegian", {{'-', "+", '='}, {'/', "-", '-'}, {'\'', "æ", '\''}, {'=', "\\", '='}}},
    {"Danish", {{'-', "+", '='}, {'/', "-", '-'}, {';', "æ", ';'}, {'1', "1", '1'}}},
    {"German", {{']', "+", '='}, {'/', "-", '-'}, {'Y', "z", 'Z'}, {'Z', "y", 'Y'}, {'[', "ü", '['}}},
    {"French",
     {{'=', "=", '='},
      {'Q', "a", 'A'},
      {'A', "q", 'Q'},
      {';', "m", 'M'},
      {'M', ",", ','},
      {'1', "&", '1'},
      {'6', "-", '6'}}},
    {"Dvorak",
     {{'\'', "-", '-'},
      {']', "=", '='},
      {'-', "[", '['},
      {'=', "]", ']'},
      {'[', "/", '/'},
      {'W', ",", ','},
      {',', "w", 'W'},
      {';', "s", 'S'},
      {'/', "z", 'Z'}}},
    {"Russian", {{'W', "ц", 'W'}, {'[', "х", '['}, {'-', "-", '-'}, {'/', ".", '/'}}},
    {"unknown", {{'-', "", '-'}, {'W', "", 'W'}}},
    {"any", {{key::kKeypadAdd, "+", key::kKeypadAdd}, {key::kEscape, "", key::kEscape}, {' ', " ", ' '}}},
};

}  // namespace

TEST_CASE("printed keys: + and -, letters and brackets are where a keyboard prints them") {
  for (const Layout& layout : kLayouts)
    for (const PrintedKey& k : layout.keys) {
      CAPTURE(layout.name);
      CAPTURE(std::string(k.printed));
      CHECK(key_meant(k.code, k.printed) == k.meant);
    }
  CHECK(action_for(key_meant('-', "+"), {}) == Action::kPartLarger);
  CHECK(action_for(key_meant('/', "-"), {.ctrl = true}) == Action::kShrink);
}
