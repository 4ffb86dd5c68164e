#include "app/window/frame_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace splatcut {

FrameLog::FrameLog(std::ostream* out) : out_(out) {
  *out_ << "second,frames,longest_ms,events_ms,update_ms,interface_ms,draw_ms,requests_ms,show_ms,working\n";
}

void FrameLog::add(const ShownFrame& frame) {
  if (!first_s_) first_s_ = frame.begin_s;
  FrameTimes& parts = longest_.parts;
  const auto second = static_cast<long>(std::floor(frame.begin_s - *first_s_));
  if (second != second_ && frames_ > 0) {
    *out_ << fmt::format("{},{},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:d}\n", second_, frames_,
                         longest_ms_, longest_.events_ms, parts.update, parts.interface, parts.draw,
                         parts.requests, longest_.show_ms, longest_.working)
          << std::flush;
    frames_ = 0;
    longest_ms_ = 0;
    longest_ = {};
  }
  second_ = second;
  ++frames_;
  const auto raise = [](double* most, double ms) { *most = std::max(*most, ms); };
  raise(&longest_ms_, frame.total_ms());
  raise(&longest_.events_ms, frame.events_ms);
  raise(&parts.update, frame.parts.update);
  raise(&parts.interface, frame.parts.interface);
  raise(&parts.draw, frame.parts.draw);
  raise(&parts.requests, frame.parts.requests);
  raise(&longest_.show_ms, frame.show_ms);
  longest_.working |= frame.working;
}

}  // namespace splatcut
