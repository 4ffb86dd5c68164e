// What is known of one cut, for the window: its times, views, doubts, what its first click can mean.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/document/document.h"
#include "core/image.h"
#include "core/stage_clock.h"
#include "segment/session/cut_result.h"

namespace splatcut {

// A view that the cut used, as the thumbnail strip shows it.
struct ViewCard {
  Camera camera;
  bool used = true;
  double confidence = 0;
  std::string reason;  // why it does not count
  std::shared_ptr<const Image<Rgba8>> picture;
  bool only_to_look = false;  // it had no influence on the cut
  std::uint64_t serial = 0;   // changes with the picture
};

// The meanings of an object's first click, once a cut has found them.
struct ClickMeanings {
  std::string key;                            // of that click, see key_of_first_stroke()
  int choice = 0;                             // whose sizes these are:
  std::size_t sizes = 0, likeliest_size = 0;  // how many, and the one that a click takes
  std::size_t size = 0;                       // the one taken
  Camera camera;                              // of the click
  // Per meaning its borders in the camera's pixels.
  std::vector<std::vector<std::vector<glm::vec2>>> outlines;
  std::vector<std::vector<glm::vec2>> smaller, larger;  // of the next sizes; empty: there is none
};

// A cut that is done, or the one that runs.
struct CutRun {
  bool running = false;
  std::string key;                          // cut_key() of what it cuts
  std::shared_ptr<const CutResult> result;  // null until it is done
  std::vector<StageTime> stages;            // so far
  std::vector<ViewCard> views;
  bool views_of_before = false;  // they are those of the object's cut before, until its own are drawn
  Flags preview;                 // labels so far
  double first_mask_ms = 0, total_ms = 0;
  std::shared_ptr<const ClickMeanings> meanings;         // of the first click, as far as it is known
  std::vector<std::string> doubts;                       // a sentence each
  std::shared_ptr<const std::vector<float>> likelihood;  // null until asked for
  bool likelihood_failed = false;                        // not asked for again
};

}  // namespace splatcut
