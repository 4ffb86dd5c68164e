// What edits make of labels: who has what, what is counted, what a lock costs; and how a history is read
// again.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <random>

#include "app/document/document_edits.h"
#include "app/document/label_cache.h"
#include "core/json_file.h"
#include "hands.h"
#include "reopened.h"
#include "synthetic_cloud.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

Flags some_flags(std::mt19937& random, std::size_t n, unsigned values) {
  if (random() % 4 == 0) return nullptr;
  std::vector<std::uint8_t> flags(n);
  for (std::uint8_t& flag : flags) flag = static_cast<std::uint8_t>(random() % values);
  return make_flags(std::move(flags));
}

Document some_objects(std::mt19937& random, std::size_t n) {
  constexpr int kObjects = 6;
  Document document;
  document.deleted = some_flags(random, n, 2);
  for (int i = 0; i < kObjects; ++i) {
    ObjectItem& object = add_object(&document);
    object.cut = some_flags(random, n, 2);
    object.hand = some_flags(random, n, 4);
    object.of_others = some_flags(random, n, 2);
    if (i > 0 && random() % 2) object.within = document.objects[random() % static_cast<unsigned>(i)].id;
  }
  return document;
}

double seconds_since(const std::chrono::steady_clock::time_point& start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

TEST_CASE("object labels: one of them is as all of them are, and a lock leaves each object what it had") {
  constexpr std::size_t kFew = 1037;  // passes take 16 at a time, and count 255: the last ones are fewer
  const GaussianCloud cloud = random_cloud(kFew, 1, 0);
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    Document document = some_objects(random, kFew), slowly = document;
    for (const ObjectItem& object : document.objects) {
      const std::vector<std::uint8_t> all = labels_of(document, object, kFew);
      for (std::size_t g = 0; g < kFew; ++g) REQUIRE(has(document, object, g) == (all[g] != 0));
    }
    edit(&document, LockObject{2, true}, {cloud});
    slowly.find(2)->locked = true;
    for (ObjectItem& other : slowly.objects)
      if (other.id != 2) leave_to_locked(slowly, &other, kFew);
    for (std::size_t i = 0; i < document.objects.size(); ++i) {
      const Flags &a = document.objects[i].of_others, &b = slowly.objects[i].of_others;
      INFO(seed, " ", i);
      REQUIRE((a != nullptr) == (b != nullptr));
      if (a) REQUIRE(*a == *b);
    }
  }
}

TEST_CASE("object labels: flags of any number are counted") {
  std::mt19937 random(1);
  for (std::size_t n = 0; n < 1100; n += n < 40 ? 1 : 51) {
    std::vector<std::uint8_t> flags(n);
    for (std::uint8_t& flag : flags) flag = static_cast<std::uint8_t>(random() % 3);
    CHECK(count_flags(flags) == n - static_cast<std::size_t>(std::ranges::count(flags, 0)));
    CHECK(count_flags(std::vector<std::uint8_t>(n, 255)) == n);
  }
}

// What a new object leaves: all that others have but those that its first click is on, and their parts.
TEST_CASE("object labels: the first click of an object leaves what others have, known from before or not") {
  constexpr std::size_t kFew = 523;
  const GaussianCloud cloud = random_cloud(kFew, 1, 0);
  LabelCache known;
  int shared = 0, refused = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    Document document = some_objects(random, kFew);
    document.objects[random() % 6].locked = true;
    add_object(&document);
    for (int i = 0; i < 8; ++i) {
      const auto hit = random() % kFew;
      const auto is_on = [&](const ObjectItem& object) { return has(document, object, hit); };
      const auto is_shared = [&](const ObjectItem& object) {
        for (const ObjectItem* o = &object; o && !o->locked; o = document.find(o->within))
          if (is_on(*o)) return true;
        return false;
      };
      const AddStroke stroke{{}, click({1, 1}, SeedLabel::kObject), {}, {static_cast<std::int32_t>(hit)}};
      for (LabelCache* labels : {static_cast<LabelCache*>(nullptr), &known}) {
        INFO(seed, " ", hit, " ", labels != nullptr);
        Document now = document;
        const EditContext context{.cloud = cloud, .labels = labels};
        if (std::ranges::any_of(document.objects, [&](auto& o) { return o.locked && is_on(o); })) {
          CHECK_THROWS(edit(&now, stroke, context));
          ++refused;
          continue;
        }
        edit(&now, stroke, context);
        std::vector<std::uint8_t> expected(kFew, 0);
        for (const ObjectItem& object : document.objects) {
          const bool is_hit = is_shared(object);
          shared += is_hit;
          for (std::size_t g = 0; !is_hit && g < kFew; ++g) expected[g] |= has(document, object, g);
        }
        const Flags& left = now.active_object()->of_others;
        REQUIRE((left != nullptr) == (count_flags(expected) > 0));
        if (left) REQUIRE(*left == expected);
      }
    }
  }
  CHECK(shared > 50);
  CHECK(refused > 50);
}

TEST_CASE("object labels: a click on what another object has shares with that one alone") {
  const GaussianCloud cloud = random_cloud(8, 1, 0);
  const Camera camera;
  Document document;
  add_object(&document).cut = make_flags({1, 1, 0, 0, 0, 0, 0, 0});
  add_object(&document).cut = make_flags({0, 0, 1, 1, 0, 0, 0, 0});
  ObjectItem& third = add_object(&document);
  third.views = {{camera, {click({1, 1}, SeedLabel::kObject)}}};
  third.cut = make_flags({1, 1, 1, 1, 1, 0, 0, 0});
  document.active = third.id;
  const auto after_click_on = [&](std::vector<std::uint8_t> left, std::int32_t hit) {
    document.find(3)->of_others = make_flags(std::move(left));
    Document now = document;
    edit(&now, AddStroke{camera, click({2, 2}, SeedLabel::kObject), {}, {hit}}, {cloud});
    return labels_of(now, *now.find(3), 8);
  };
  using Labels = std::vector<std::uint8_t>;
  CHECK(after_click_on({1, 1, 1, 1, 0, 0, 0, 0}, 4) == Labels{0, 0, 0, 0, 1, 0, 0, 0});
  CHECK(after_click_on({1, 1, 1, 1, 0, 0, 0, 0}, 2) == Labels{0, 0, 1, 1, 1, 0, 0, 0});
  // What nobody has any more is the object's again, and nothing else.
  CHECK(after_click_on({1, 1, 1, 1, 1, 0, 0, 0}, 4) == Labels{0, 0, 0, 0, 1, 0, 0, 0});
}

TEST_CASE(
    "object labels: locking hundred objects one by one keeps the window waiting for less than a second "
    "each") {
  constexpr std::size_t kGaussians = 60000, kObjects = 100;
  const GaussianCloud cloud = random_cloud(kGaussians, 1, 0);
  Document document;
  for (std::size_t i = 0; i < kObjects; ++i) {
    std::vector<std::uint8_t> cut(kGaussians, 0);
    for (std::size_t g = i; g < kGaussians; g += kObjects) cut[g] = 1;
    add_object(&document).cut = make_flags(std::move(cut));
  }
  const auto start = std::chrono::steady_clock::now();
  for (ObjectId id = 1; id <= kObjects; ++id) edit(&document, LockObject{id, true}, {cloud});
  MESSAGE(seconds_since(start), " s for all locks");
  CHECK(seconds_since(start) < 3);
  CHECK(count_flags(*document.objects[0].of_others) == kGaussians - kGaussians / kObjects);
}

TEST_CASE("object labels: what an edit adds is what changes, and what is deleted is not marked") {
  const GaussianCloud cloud = random_cloud(4, 1, 0);
  const EditContext context{cloud};
  Document document;
  add_object(&document);
  document.deleted = make_flags({0, 0, 0, 1});
  CHECK(
      edit_selection(&document, {0, 1, 1, 1}, SetOperation::kAdd, context).starts_with("2 Gaussians added"));
  CHECK((*document.objects[0].hand)[3] == kFollowCut);
  edit(&document, EditSelection{SelectionEdit::kAll}, context);
  CHECK((*document.objects[0].hand)[3] == kFollowCut);
  ObjectItem& part = add_object(&document);
  part.within = 1;
  document.objects[0].hand = make_flags({kHandObject, 0, 0, 0});
  CHECK(edit_selection(&document, {1, 1, 0, 0}, SetOperation::kAdd, context).starts_with("1 Gaussian added"));
}

TEST_CASE("object labels: keys read a large array once, however often they are made") {
  ObjectItem object;
  object.views.push_back({{}, {}, make_flags(std::vector<std::uint8_t>(std::size_t{64} << 20, 1))});
  const auto start = std::chrono::steady_clock::now();
  const std::string key = cut_key({}, object);
  for (int i = 0; i < 1000; ++i) CHECK(cut_key({}, object) == key);
  MESSAGE(seconds_since(start), " s for 1,001 keys");
  CHECK(seconds_since(start) < 2);
  object.views[0].seen = make_flags(std::vector<std::uint8_t>(std::size_t{64} << 20, 0));
  CHECK(cut_key({}, object) != key);
}

TEST_CASE("object labels: the list of steps names the same objects once work is opened again") {
  const ScratchFolder folder("row_titles");
  Hands hands;
  Studio& studio = hands.studio();
  const ObjectId apple = studio.document().active;
  studio.apply(NewObject{});
  studio.apply(EditSelection{SelectionEdit::kAll});
  REQUIRE(hands.app.settle());
  studio.apply(EditSelection{SelectionEdit::kInvert});
  REQUIRE(hands.app.settle());
  studio.apply(RenameObject{apple, "Apple"});
  const auto rows = [](const Studio& s) {
    std::vector<std::string> titles;
    for (std::size_t i = 1; i < s.history().entries().size(); ++i)
      titles.push_back(row_title(s.history(), i));
    return titles;
  };
  const auto expected = rows(studio);
  REQUIRE(expected.back().find("(Apple)") != std::string::npos);
  const auto again = reopened(hands, folder);
  CHECK(rows(again->studio()) == expected);
}

TEST_CASE("object labels: all objects in one file do not take a file of others along") {
  const ScratchFolder folder("foreign_names");
  Hands hands;
  const std::string cameras = "{\"cameras\": []}\n";
  std::ofstream(folder / "all.json") << cameras;
  Export all;
  all.request = {.what = ExportWhat::kOneFile, .path = folder / "all.ply", .overwrite = true};
  hands.studio().apply(all);
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find("holds something else") != std::string::npos);
  CHECK(json_of_file(folder / "all.json").contains("cameras"));
  CHECK_FALSE(std::filesystem::exists(folder / "all.ply"));
  std::filesystem::remove(folder / "all.json");
  for (int again = 0; again < 2; ++again) {  // its own names are written over
    hands.studio().apply(all);
    REQUIRE(hands.app.settle());
    CHECK(json_of_file(folder / "all.json").contains("objects"));
  }
  CHECK(hands.said().find("saved to") != std::string::npos);
}
