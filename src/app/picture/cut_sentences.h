// What is said of a finished cut. Nothing throws.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/document/history.h"
#include "app/picture/cut_run.h"

namespace splatcut {

// The message after a cut: the size of the object, and what the last step changed. before, after: labels of
// the scene's Gaussians, of one length.
std::string what_changed(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after,
                         double seconds);

bool is_of_stroke(const History& history);  // the last that was done is a stroke

// Less of the object than can be seen. before, after: as above.
bool changed_little(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after);

// Strokes at the history's end that the object's next cut computes together, as no cut of them is there yet.
std::size_t waiting_strokes(const History& history, ObjectId object);

// Right clicks in a row, up to 3, each of which changed little of the object, up to the last step.
std::size_t small_removals(const History& history, ObjectId object, std::size_t gaussians);

// Of a last click that asks for what is so already: that it does, and what to do for more. little_changed:
// some of that place was not so.
std::string why_so_already(const CutRequest& request, const CutResult& result, bool little_changed = false);

// That there is no larger size, and what may take more: nothing where nearly all is taken. taken, all: of the
// scene's Gaussians.
std::string why_no_larger(std::size_t taken, std::size_t all);
// The same where it has one size alone; steps: which way was asked for.
std::string why_one_size(int steps, bool takes_away);

// Of a step to the next size, from so many Gaussians to so many: that it is a leap, and what finds something
// between; empty: it is none.
std::string leap_of_size(std::size_t was, std::size_t is);

// What the wheel does after a click: a hint, no doubt. Empty: there is no other size, or a first click is
// clear, or its other meanings are offered, one question at a time. What changed too little to be seen was
// not too much. before, after: as above.
std::string wheel_hint(const CutRequest& request, const CutResult& result,
                       const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after);

// Adds to the doubts that sides, perhaps the user's own, are in doubt by their pictures; returns false if
// none is. Without their number: marks are counted in the thumbnails, where they come and go.
inline constexpr const char* kDoubtOfSides = "sides in doubt are marked in the thumbnails";
bool add_doubt_of_sides(CutRun* run);

// Names another object most of which the object holds, too; empty: there is none. Objects may overlap, but a
// click that takes most of another one is rarely meant. id: of an object of the document. labels: of each
// object, of one length.
using LabelsOfObject = std::function<Flags(const ObjectItem&)>;
std::string shared_with(const Document& document, ObjectId id, const LabelsOfObject& labels_of_object);

// What the thumbnail of a view says of it. steady: without numbers that differ between runs.
std::string tip_of_card(const ViewCard& card, std::size_t index, bool steady);

}  // namespace splatcut
