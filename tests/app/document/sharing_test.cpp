// With whom strokes and shapes share, where several others have something there or get it later.
#include <doctest/doctest.h>

#include "app/document/document_edits.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

using Bytes = std::vector<std::uint8_t>;
using HitLists = std::vector<std::vector<std::int32_t>>;

constexpr std::size_t kEight = 8;
constexpr ObjectId kPot = 1, kPlant = 2, kLeaf = 3;  // in the order in which they are begun

// Pot: 0 to 2. Leaf: 3 and 4. Plant: a cut that would take all, and leaves the pot alone; the leaf's cut was
// on its way when the plant was begun.
Document pot_plant_and_leaf() {
  Document document;
  add_object(&document).cut = make_flags({1, 1, 1, 0, 0, 0, 0, 0});
  ObjectItem& plant = add_object(&document);
  plant.cut = make_flags(Bytes(kEight, 1));
  plant.of_others = document.find(kPot)->cut;
  plant.leaves_also = {kLeaf};
  add_object(&document).cut = make_flags({0, 0, 0, 1, 1, 0, 0, 0});
  document.active = kPlant;
  return document;
}

Bytes left_once_leaf_came(const Document& document, const HitLists& hits) {
  const ObjectId came[] = {kLeaf};
  const ObjectItem plant = left_what_came(
      document, *document.find(kPlant), came, [&] { return hits; }, kEight);
  CHECK(plant.leaves_also == std::vector<ObjectId>(document.find(kPlant)->leaves_also.begin() + 1,
                                                   document.find(kPlant)->leaves_also.end()));
  return plant.of_others ? *plant.of_others : Bytes(kEight, 0);
}

Bytes labels_after_click_on(Document document, ObjectId object, std::int32_t hit) {
  document.active = object;
  edit(&document, AddStroke{Camera{}, click({2, 2}, SeedLabel::kObject), {}, {hit}},
       {random_cloud(kEight, 1, 0)});
  return labels_of(document, *document.find(object), kEight);
}

// Pot: 0 to 3. Leaf: 3 and 4, begun on the pot. Plant, begun last: leaves both, and its cut would take all.
Document leaf_on_pot() {
  Document document = pot_plant_and_leaf();
  document.find(kPot)->cut = make_flags({1, 1, 1, 1, 0, 0, 0, 0});
  ObjectItem& plant = *document.find(kPlant);
  plant.leaves_also.clear();
  plant.of_others = make_flags({1, 1, 1, 1, 1, 0, 0, 0});
  plant.views = {{Camera{}, {click({1, 1}, SeedLabel::kObject)}}};
  return document;
}

}  // namespace

TEST_CASE("sharing: with what came later on a stroke the object shares that alone, and waits for the rest") {
  Document document = pot_plant_and_leaf();
  CHECK(left_once_leaf_came(document, {{6}}) == Bytes{1, 1, 1, 1, 1, 0, 0, 0});
  CHECK(left_once_leaf_came(document, {{6}, {4}}) == Bytes{1, 1, 1, 0, 0, 0, 0, 0});
  document.find(kPlant)->leaves_also = {kLeaf, 4};
  CHECK(left_once_leaf_came(document, {{4}}) == Bytes{1, 1, 1, 0, 0, 0, 0, 0});
  document.find(kPot)->locked = true;
  CHECK(left_once_leaf_came(document, {{4}}) == Bytes{1, 1, 1, 0, 0, 0, 0, 0});
  document.find(kLeaf)->locked = true;
  CHECK(left_once_leaf_came(document, {{4}}) == Bytes{1, 1, 1, 1, 1, 0, 0, 0});
}

TEST_CASE("sharing: a stroke on what the object left before takes nothing of that when another's cut comes") {
  const Document document = pot_plant_and_leaf();
  CHECK(left_once_leaf_came(document, {{0}, {4}}) == Bytes{1, 1, 1, 0, 0, 0, 0, 0});
}

TEST_CASE("sharing: what hands took of one object stays where a click shares with another") {
  Document document = pot_plant_and_leaf();
  ObjectItem& plant = *document.find(kPlant);
  plant.leaves_also.clear();
  plant.of_others = make_flags({1, 1, 1, 1, 1, 0, 0, 0});
  plant.views = {{Camera{}, {click({1, 1}, SeedLabel::kObject)}}};
  plant.hand = make_flags({kHandObject, kHandLeft, 0, kHandLeft, 0, 0, 0, 0});
  CHECK(labels_after_click_on(document, kPlant, 4) == Bytes{1, 0, 0, 1, 1, 1, 1, 1});
}

TEST_CASE("sharing: a shape that begins an object on another shares with that one alone, as a click does") {
  Document document = pot_plant_and_leaf();
  edit(&document, NewObject{}, {random_cloud(kEight, 1, 0)});
  document.find(kPlant)->cut = make_flags({0, 0, 0, 0, 0, 0, 1, 0});
  edit_by_shape(&document, {1, 1, 0, 0, 0, 0, 0, 0}, SetOperation::kAdd, {random_cloud(kEight, 1, 0)});
  const ObjectItem& shaped = *document.active_object();
  CHECK(labels_of(document, shaped, kEight) == Bytes{1, 1, 0, 0, 0, 0, 0, 0});
  REQUIRE(shaped.of_others);
  CHECK(*shaped.of_others == Bytes{0, 0, 0, 1, 1, 0, 1, 0});  // for the next click's cut
}

TEST_CASE("sharing: what a click's object shares with others that the click is not on stays theirs") {
  Document document = leaf_on_pot();
  CHECK(labels_after_click_on(document, kPlant, 0) == Bytes{1, 1, 1, 0, 0, 1, 1, 1});
  CHECK(labels_after_click_on(document, kPlant, 3) == Bytes(kEight, 1));  // both have that
  document.find(kLeaf)->locked = true;
  CHECK(labels_after_click_on(document, kPlant, 0) == Bytes{1, 1, 1, 0, 0, 1, 1, 1});
}

TEST_CASE("sharing: clicks on one object after the other share all that these have") {
  Document document = leaf_on_pot();
  document.active = kPlant;
  for (const std::int32_t hit : {0, 4})
    edit(&document, AddStroke{Camera{}, click({2, 2}, SeedLabel::kObject), {}, {hit}},
         {random_cloud(kEight, 1, 0)});
  CHECK(labels_of(document, *document.find(kPlant), kEight) == Bytes(kEight, 1));
}

TEST_CASE("sharing: a click on what nobody has any more takes nothing that another has") {
  Document document = leaf_on_pot();
  document.find(kPlant)->of_others = make_flags({1, 0, 0, 0, 0, 1, 0, 0});  // most of the pot is shared
  CHECK(labels_after_click_on(document, kPlant, 5) == Bytes{0, 1, 1, 1, 1, 1, 1, 1});
}

TEST_CASE("sharing: a whole that is clicked shares what its parts have, but for locked ones") {
  Document document = leaf_on_pot();
  document.find(kLeaf)->within = kPot;
  CHECK(labels_after_click_on(document, kPlant, 0) == Bytes{1, 1, 1, 1, 0, 1, 1, 1});
  document.find(kLeaf)->locked = true;
  CHECK(labels_after_click_on(document, kPlant, 0) == Bytes{1, 1, 1, 0, 0, 1, 1, 1});
}

TEST_CASE(
    "sharing: a click taken away ends its sharing, though what the object waited for is still to come") {
  const GaussianCloud cloud = random_cloud(kEight, 1, 0);
  Document document = leaf_on_pot();
  document.find(kPlant)->leaves_also = {kLeaf};  // it has yet another size on its way
  History history;
  history.reset(document, "Open");
  const auto labels_now = [&](const Document& now) { return labels_of(now, *now.find(kPlant), kEight); };
  REQUIRE(labels_now(document) == Bytes{0, 0, 0, 0, 0, 1, 1, 1});
  edit(&document, AddStroke{Camera{}, click({2, 2}, SeedLabel::kObject), {}, {0}}, {cloud});
  REQUIRE(labels_now(document)[0] == 1);
  history.push("Click", document);
  const RemoveStroke gone{0, 1, {2, 2}};
  edit(&document, gone, {cloud});
  take_back_sharing(history, gone, &document, kEight);
  CHECK(labels_now(document) == Bytes{0, 0, 0, 0, 0, 1, 1, 1});
  CHECK(document.find(kPlant)->leaves_also == std::vector<ObjectId>{kLeaf});
}
