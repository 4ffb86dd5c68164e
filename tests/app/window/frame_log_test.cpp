#include "app/window/frame_log.h"

#include <doctest/doctest.h>

#include <sstream>

using namespace splatcut;

TEST_CASE("frame log: a line for each second with its longest frame and the longest of every part") {
  std::ostringstream out;
  FrameLog log(&out);
  log.add({100.25, 1, {1, 5, 1, 0}, 2, true});
  log.add({100.5, 3, {10, 4, 2, 0.5}, 8, false});
  log.add({101.2, 0, {}, 1, false});   // 0.95 s after the first: the same second
  log.add({101.25, 0, {}, 7, false});  // second 1
  log.add({104.5, 0, {}, 9, false});   // second 4, not complete
  CHECK(out.str() ==
        "second,frames,longest_ms,events_ms,update_ms,interface_ms,draw_ms,requests_ms,show_ms,working\n"
        "0,3,27.5,3.0,10.0,5.0,2.0,0.5,8.0,1\n"
        "1,1,7.0,0.0,0.0,0.0,0.0,0.0,7.0,0\n");
}
