// The longest frames of every second of a window, as CSV: what a user feels as a stall.
#pragma once

#include <iosfwd>
#include <optional>

#include "app/window/application.h"

namespace splatcut {

struct ShownFrame {
  double begin_s = 0;    // on any clock
  double events_ms = 0;  // answering what came before it
  FrameTimes parts;
  double show_ms = 0;    // until the screen has it; waits for the screen's own rate, too
  bool working = false;  // while something that the user asked for is computed
  double total_ms() const { return events_ms + parts.total() + show_ms; }
};

class FrameLog {
 public:
  explicit FrameLog(std::ostream* out);  // outlives this
  // Frames one after the other. A second is written when a frame of a later one comes: the longest of its
  // frames, the longest of every part (of any of them), 1 where one of them was `working`. Seconds without a
  // frame are left out.
  void add(const ShownFrame& frame);

 private:
  std::ostream* out_;
  std::optional<double> first_s_;
  long second_ = 0;  // from the first frame on
  int frames_ = 0;
  double longest_ms_ = 0;
  ShownFrame longest_;  // of every part
};

}  // namespace splatcut
