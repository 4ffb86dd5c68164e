// What is said of a finished cut.
#include "app/picture/cut_sentences.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>

#include "segment/masks/seeds.h"
#include "segment/session/doubts.h"

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
  CutRequest second;
  second.strokes = {{{}, {click({5, 5}, SeedLabel::kObject), click({9, 9}, SeedLabel::kRest)}, {}}};
  const std::vector<std::uint8_t> before(1000, 1);
  CutResult result;
  result.spot_alone = true;
  const auto said = [&](std::size_t size, std::size_t sizes) {
    result.size = size;
    result.sizes = sizes;
    return doubts_of(result).front() + wheel_hint(second, result, before, before);
  };
  CHECK(said(0, 3) == "the last click changed the spot around it alone. The wheel takes more away");
  CHECK(said(2, 3) == "the last click changed the spot around it alone: scribble over all that is meant");
  CHECK(said(0, 0) == "the last click changed the spot around it alone: scribble over all that is meant");
  result.spot_alone = false;
  CHECK(doubts_of(result).empty());
}

TEST_CASE("sentences: what another object keeps of a cut is said from a hundredth of the object on") {
  // Of 1000 Gaussians the cut took `taken` of those that are the mug's own, and 200 others.
  const auto said = [](std::size_t taken) {
    Document document;
    ObjectItem mug, plate;
    mug.id = 1;
    mug.name = "Mug";
    plate.id = 2;
    plate.name = "Plate";
    std::vector<std::uint8_t> cut(1000, 0), of_mug(1000, 0), of_plate(1000, 0);
    std::fill_n(of_mug.begin(), 100, 1);
    std::fill_n(cut.begin(), taken, 1);
    for (auto* flags : {&cut, &of_plate}) std::fill_n(flags->begin() + 200, 200, 1);
    const auto flags_of = [](std::vector<std::uint8_t> flags) {
      return std::make_shared<const std::vector<std::uint8_t>>(std::move(flags));
    };
    plate.cut = flags_of(cut);
    plate.of_others = flags_of(of_mug);
    document.objects = {mug, plate};
    return shared_with(document, 2, [&](const ObjectItem& item) {
      return item.id == 1 ? flags_of(of_mug) : flags_of(of_plate);
    });
  };
  CHECK(said(0).empty());
  CHECK(said(1).empty());
  CHECK(said(2) ==
        ". 2 Gaussians that Mug had before stay its own; the menu of Plate has a way to take them, too");
}
