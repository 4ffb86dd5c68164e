// The one error type of the project: trouble with the environment (a file, an option, a context),
// worded for the person who uses the program. Thrown where the fact is known. It reaches the person in
// main(), in Studio::apply and in TaskThread; elsewhere it is caught only to say more about it, or where the
// program can do without. Programmer mistakes are asserts; expected outcomes are values in reports.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace splatcut {

class Error : public std::runtime_error {
 public:
  // where: the file, option or stage; empty for what a user did in the window, where `what` begins with a
  // capital letter. what: the fact, with property, row or byte. remedy: what the user can do about it (may be
  // empty). Message: "where: what. remedy."
  Error(std::string_view where, std::string_view what, std::string_view remedy = {});

  // The message without its full stop: as the `what` of an error that says where more fully.
  std::string_view unstopped() const;
};

// A sentence for the person on any exception: Error's own words, otherwise what the system says or that the
// program has a defect; never the words of a library.
std::string sentence_of(const std::exception& error);

}  // namespace splatcut
