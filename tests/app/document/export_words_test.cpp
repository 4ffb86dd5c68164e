// What is said of an export: before it is written, in its dialog, and of what was written.
#include <doctest/doctest.h>

#include <memory>

#include "app/document/export_choice.h"
#include "app/document/export_plan.h"

using namespace splatcut;

TEST_CASE("exports: what is said of them names objects whose edges stay, and promises no number of a hole") {
  CleanReport good, bad, other;
  good.cleaned = true;
  bad.why_not = "no side shows it";
  other.why_not = "3 Gaussians have no edges";
  ExportReport one;
  count_edges(bad, &one);
  CHECK(edges_text(one) == ". Edges stay as they are: " + bad.why_not);
  ExportReport several;
  count_edges(good, &several, "Apple");
  count_edges(bad, &several, "Mug");
  CHECK(edges_text(several) == ", edges of some cleaned. Edges of Mug stay as they are: " + bad.why_not);
  count_edges(other, &several, "Cup");
  CHECK(edges_text(several) ==
        ", edges of some cleaned. Edges of 2 objects stay as they are, Mug the first: " + bad.why_not);
}

TEST_CASE("exports: the dialog says what is written, and of what is moved that it is, not that it is kept") {
  const FormatPlan plan{.bytes = 1, .kept = "Places and colours.", .lost = {}};
  ExportChoice choice;
  CHECK(kept_text(choice, plan) == "Kept: places and colours.");
  CHECK(moved_text(choice.placement).empty());
  CHECK(kept_text(choice, plan, "The hole is filled.") ==
        "Written, with the changes named below: places and colours.");
  choice.placement.scale = 2;
  CHECK(kept_text(choice, plan) == "Written: places and colours.");
  CHECK(moved_text(choice.placement) == "It stands as chosen above, not as in the scene.");
}

TEST_CASE("exports: the dialog promises a number, and that nothing is lost, only where that holds") {
  ExportChoice choice;
  const FormatPlan plan{.bytes = 4'300'000, .kept = "all", .lost = {}};
  EdgesKnown rows;
  CHECK(amount_text(choice, 17466, rows, {}, plan) == "17,466 Gaussians, 4.3 MB");
  CHECK(loss_text(choice, rows, {}, plan) == "Nothing is lost.");
  EdgesKnown not_yet{.clean = true};
  not_yet.count({}, "Apple");
  CHECK(amount_text(choice, 17466, not_yet, {}, plan) == "At most 17,466 Gaussians, 4.3 MB");
  CHECK(changes_text(choice, not_yet, {}) ==
        "Clean edges leave out what only shows, as ragged bits, once the object stands alone, and trim or "
        "recolour others. Untick them to write all as it is.");
  CHECK(loss_text(choice, not_yet, {}, plan).empty());
  EdgesKnown cleaned{.clean = true}, stays{.clean = true};
  cleaned.count(CleanReport{.cleaned = true, .left = 214}, "Apple");
  stays.count(CleanReport{.why_not = "3 Gaussians have no edges"}, "Mug");
  CHECK(amount_text(choice, 46423, cleaned, {}, plan) == "46,209 Gaussians, 4.3 MB");
  CHECK(changes_text(choice, cleaned, {}) ==
        "Clean edges leave out 214 Gaussians that only show, as ragged bits, once the object stands alone, "
        "and trim or recolour others. Untick them to write all as it is.");
  CHECK(edges_stay_text(cleaned).empty());
  CHECK(amount_text(choice, 46423, stays, {}, plan) == "46,423 Gaussians, 4.3 MB");
  CHECK(edges_stay_text(stays) == "Clean edges leave Mug as it is: 3 Gaussians have no edges.");
  CHECK(loss_text(choice, stays, {}, plan) == "Nothing is lost.");
  choice.what = ExportWhat::kAllObjects;
  EdgesKnown all = cleaned;
  all.count(CleanReport{.why_not = "3 Gaussians have no edges"}, "Mug");
  CHECK(edges_stay_text(all) == "Clean edges leave Mug as it is: 3 Gaussians have no edges.");
  CHECK(changes_text(choice, all, {}) ==
        "Clean edges leave out 214 Gaussians that only show, as ragged bits, once the object stands alone, "
        "and trim or recolour others. Untick them to write all as it is.");
  all.count(CleanReport{.why_not = "it is not seen"}, "Cup");
  CHECK(edges_stay_text(all) ==
        "Clean edges leave 2 objects as they are (Mug the first): 3 Gaussians have no edges.");
  choice.what = ExportWhat::kRest;
  for (const EdgesKnown& edges : {not_yet, cleaned}) {
    CHECK(amount_text(choice, 139338, edges, {}, plan) == "About 139,338 Gaussians, about 4.3 MB");
    CHECK(
        changes_text(choice, edges, {}) ==
        "Clean edges leave out faint remains of the object, too; what they trim off the object stays here.");
    CHECK(loss_text(choice, edges, {}, plan).empty());
  }
  CHECK(amount_text(choice, 139338, stays, {}, plan) == "139,338 Gaussians, 4.3 MB");
  CHECK(loss_text(choice, stays, {}, plan) == "Nothing is lost.");
  const HoleKnown coming{.fill = true};
  CHECK(amount_text(choice, 139338, rows, coming, plan) == "About 139,338 Gaussians, about 4.3 MB");
  CHECK(changes_text(choice, rows, coming) ==
        "If the object touches a flat surface, that is continued into the hole: what lies there and at the "
        "rim is replaced, and what fills it is invented.");
  CHECK(loss_text(choice, rows, coming, plan).empty());
  SceneWithout filled, refused;
  filled.patch.changes.given_back.resize(1234, 0);
  refused.patch.why_not = "there is no hole in what the object stands on";
  const HoleKnown fills{true, std::make_shared<const SceneWithout>(filled)},
      stays_open{true, std::make_shared<const SceneWithout>(refused)};
  CHECK(changes_text(choice, rows, fills) ==
        "The hole is filled by 1,234 Gaussians, all invented; what lies there and at the rim is replaced.");
  CHECK(amount_text(choice, 139338, rows, fills, plan) == "About 140,572 Gaussians, about 4.3 MB");
  CHECK(fills.why_not().empty());
  CHECK(stays_open.why_not() == refused.patch.why_not);
  CHECK(amount_text(choice, 139338, rows, stays_open, plan) == "139,338 Gaussians, 4.3 MB");
  CHECK(changes_text(choice, rows, stays_open).empty());
  choice.what = ExportWhat::kObject;  // which leaves its hole elsewhere
  CHECK(changes_text(choice, rows, fills).empty());
  choice.what = ExportWhat::kOneFile;
  CHECK(loss_text(choice, rows, {}, plan) == "Nothing is lost.");
  choice.format = SceneFormat::kSplat;  // it does not say which object a Gaussian is of
  CHECK(loss_text(choice, rows, {}, plan).empty());
  CHECK(numbers_text(choice) == "Which object a Gaussian belongs to is kept in a .ply alone.");
}

TEST_CASE("exports: of several objects the dialog says whose file it is, and who stays in the rest") {
  Document document;
  CHECK(whose_text(document, ExportWhat::kRest).empty());
  const Flags some = make_flags({1, 0});
  add_object(&document).cut = some;
  CHECK(whose_text(document, ExportWhat::kObject).empty());
  CHECK(whose_text(document, ExportWhat::kRest).empty());
  add_object(&document).cut = some;
  add_object(&document);  // nothing is in it yet
  document.active = document.objects[1].id;
  CHECK(whose_text(document, ExportWhat::kObject) == "Of Object 2 alone.");
  CHECK(whose_text(document, ExportWhat::kRest) == "All but Object 2: Object 1 stays in it.");
  for (int i = 0; i < 4; ++i) add_object(&document).hand = some;
  document.active = document.objects[1].id;
  CHECK(whose_text(document, ExportWhat::kRest) ==
        "All but Object 2: Object 1, Object 4, Object 5 and 2 more stay in it.");
  CHECK(whose_text(document, ExportWhat::kAllObjects).empty());
  CHECK(whose_text(document, ExportWhat::kScene).empty());
}
