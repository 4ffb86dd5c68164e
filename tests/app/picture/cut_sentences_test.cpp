// What is said of a finished cut.
#include "app/picture/cut_sentences.h"

#include <doctest/doctest.h>

#include "segment/masks/seeds.h"

using namespace splatcut;

TEST_CASE("sentences: after a click the hint says what the wheel does, and puts no good answer in doubt") {
  CutRequest first, second;
  first.strokes = {{{}, {click({5, 5}, SeedLabel::kObject)}, {}}};
  second.strokes = {{{}, {click({5, 5}, SeedLabel::kObject), click({9, 9}, SeedLabel::kObject)}, {}}};
  const std::vector<std::uint8_t> before(100, 0), after(100, 1);
  CutResult result;
  const auto hint = [&](const CutRequest& request, std::size_t size, std::size_t sizes) {
    result.size = size;
    result.sizes = sizes;
    return wheel_hint(request, result, before, after);
  };
  const auto hint_of_little = [&](std::size_t size) {
    result.size = size;
    return wheel_hint(second, result, after, after);
  };
  CHECK(hint(first, 1, 3).empty());  // nothing in doubt
  CHECK(hint(second, 1, 3) == ". The wheel takes more or less");
  CHECK(hint(second, 0, 3) == ". The wheel takes more");
  CHECK(hint(second, 2, 3) == ". The wheel takes less");
  CHECK(hint(second, 0, 1).empty());
  result.sizes = 3;
  CHECK(hint_of_little(1) == ". The wheel takes more");
  CHECK(hint_of_little(2).empty());
  result.certainty = 0.5;
  CHECK(hint(first, 1, 3) == ". The wheel takes more or less");
  CHECK(hint(first, 0, 1).empty());
  result.meanings.resize(3);  // the bar offers them
  CHECK(hint(first, 1, 3).empty());
}

TEST_CASE("sentences: of a click that changed the spot around it alone there is one advice, and it works") {
  CutRequest adds, removes;
  adds.strokes = {{{}, {click({5, 5}, SeedLabel::kObject)}, {}}};
  removes.strokes = {{{}, {click({5, 5}, SeedLabel::kObject), click({9, 9}, SeedLabel::kRest)}, {}}};
  CutResult result;
  result.spot_alone = true;
  const auto said = [&](const CutRequest& request, std::size_t size, std::size_t sizes) {
    result.size = size;
    result.sizes = sizes;
    const std::vector<std::string> all = doubts_to_show(request, result);
    return all.empty() ? "" : all.front();
  };
  CHECK(said(adds, 0, 3) == "the click changed the spot around it alone: turn the wheel for more");
  CHECK(said(adds, 2, 3) == "the click changed the spot around it alone: scribble over what is missing");
  CHECK(said(adds, 0, 0) == "the click changed the spot around it alone: scribble over what is missing");
  CHECK(said(removes, 0, 1) ==
        "the click changed the spot around it alone: scribble with the right button over what is too much");
  result.spot_alone = false;
  CHECK(said(adds, 0, 3).empty());
}
