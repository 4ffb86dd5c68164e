// What is said of a finished cut. Nothing throws.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/picture/cut_run.h"
#include "app/studio/workspace.h"

namespace splatcut {

// The message after a cut: the size of the object, and what the last step changed. before, after: labels of
// the scene's Gaussians, of one length.
std::string what_changed(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after,
                         double seconds);

// Adds to the doubts how many sides, the user's own among them, are in doubt by their pictures, each of which
// has a mark; returns false if none is.
bool add_doubt_of_sides(CutRun* run);

// Names another object most of which the object holds, too; empty: there is none. Objects may overlap, but a
// click that takes most of another one is rarely meant. id: of an object of the document.
std::string shared_with(const Workspace& workspace, ObjectId id);

// What the thumbnail of a view says of it. steady: without numbers that differ between runs.
std::string tip_of_card(const ViewCard& card, std::size_t index, bool steady);

}  // namespace splatcut
