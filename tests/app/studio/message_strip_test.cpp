// Which message the window shows: none is gone before it could be read because of what came by itself.
#include <doctest/doctest.h>

#include <deque>
#include <string>

#include "app/workspace/messages.h"
#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

using Kind = Message::Kind;

TEST_CASE(
    "messages: a warning stays until it could be read, then the newest of what came meanwhile is shown") {
  const std::string warning = "That changed nothing. Click nearer to what is wrong";  // 4 s
  const auto text_at = [](const std::deque<Message>& messages, double now_s) {
    const Message* shown = shown_message(messages, now_s);
    return shown ? shown->text : std::string();
  };
  std::deque<Message> messages = {{Kind::kRefused, warning, 10}, {Kind::kDone, "saved", 10.5}};
  CHECK(text_at(messages, 9) == "");
  CHECK(text_at(messages, 10.5) == warning);
  CHECK(text_at(messages, 13.9) == warning);
  CHECK(text_at(messages, 14.2) == "saved");
  CHECK(text_at(messages, 20.9) == "saved");  // its own seven seconds
  CHECK(text_at(messages, 21.2) == "");
  messages.push_back({Kind::kInfo, "edges", 12});
  CHECK(text_at(messages, 13.9) == warning);
  CHECK(text_at(messages, 14.2) == "edges");
  messages.push_back({Kind::kError, "the disk is full", 12.5});  // says more than the first
  CHECK(text_at(messages, 12.6) == "the disk is full");
  CHECK(text_at(messages, 19.4) == "the disk is full");
  CHECK(text_at(messages, 19.6) == "");  // what came before it is not shown after it
}

TEST_CASE("messages: that a file is written can be read, whatever comes behind or before it") {
  const auto text_at = [](const std::deque<Message>& messages, double now_s) {
    const Message* shown = shown_message(messages, now_s);
    return shown ? shown->text : std::string();
  };
  const std::string saved = "apple.ply is saved here";  // 2.4 s
  std::deque<Message> messages = {{Kind::kDone, saved, 10, true}, {Kind::kInfo, "Now at: a click", 10.1}};
  CHECK(text_at(messages, 12) == saved);
  CHECK(text_at(messages, 12.6) == "Now at: a click");
  messages.push_back({Kind::kError, "disk", 11});  // 1.2 s
  CHECK(text_at(messages, 11.1) == "disk");
  messages = {{Kind::kDone, saved, 10, true}, {Kind::kError, "disk", 10.5}};
  CHECK(text_at(messages, 11) == "disk");
  CHECK(text_at(messages, 12) == saved);
  messages = {{Kind::kError, "disk", 9.5}, {Kind::kDone, saved, 10, true}, {Kind::kInfo, "click", 10.2}};
  CHECK(text_at(messages, 10.5) == "disk");
  CHECK(text_at(messages, 11) == saved);
}

TEST_CASE("messages: files that are written one after the other are each said until that could be read") {
  const auto text_at = [](const std::deque<Message>& messages, double now_s) {
    const Message* shown = shown_message(messages, now_s);
    return shown ? shown->text : std::string();
  };
  std::deque<Message> messages = {{Kind::kDone, "apple.ply is saved here", 10, true},  // 2.4 s each
                                  {Kind::kDone, "melon.ply is saved here", 10.2, true},
                                  {Kind::kInfo, "Now at: a click", 10.3},
                                  {Kind::kDone, "berry.ply is saved here", 10.4, true}};
  CHECK(text_at(messages, 12.3) == "apple.ply is saved here");
  CHECK(text_at(messages, 12.5) == "melon.ply is saved here");
  CHECK(text_at(messages, 14.9) == "berry.ply is saved here");
  CHECK(text_at(messages, 21.7) == "berry.ply is saved here");  // its own seven seconds
  CHECK(text_at(messages, 21.9) == "");
  messages.push_back({Kind::kRefused, "disk", 11, true});  // 1.2 s
  CHECK(text_at(messages, 12) == "disk");
  CHECK(text_at(messages, 12.4) == "apple.ply is saved here");
  CHECK(text_at(messages, 14.7) == "melon.ply is saved here");
}

TEST_CASE("messages: what is known of an answer later stands beside it, or alone once that is gone") {
  std::deque<Message> messages = {{Kind::kDone, "Mug: 1,200 Gaussians cut out in 0.4 s", 3}};
  REQUIRE(add_to_shown(Kind::kInfo, "Mug: sides in doubt are marked", 4, &messages));
  CHECK(messages.back().text == "Mug: 1,200 Gaussians cut out in 0.4 s; sides in doubt are marked");
  CHECK(messages.back().kind == Kind::kInfo);  // no tick
  REQUIRE(add_to_shown(Kind::kInfo, "Clean edges leave Mug as it is: no side shows it", 5, &messages));
  CHECK(messages.back().text.ends_with("are marked\nClean edges leave Mug as it is: no side shows it"));
  CHECK(messages.size() == 1);
  CHECK(shown_message(messages, 11.9) == &messages.back());  // time to read what came
  CHECK_FALSE(add_to_shown(Kind::kInfo, "Mug: later", 60, &messages));
  CHECK(messages.size() == 1);
}

TEST_CASE("messages: one that has no room keeps its first sentence, and its last if it can") {
  const std::string first = "Mug: 12,345 Gaussians cut out in 0.4 s", last = "Two sides are in doubt",
                    middle = "what stands between says little";
  const auto within = [](std::size_t letters) {
    return [letters](const std::string& shown) { return shown.size() <= letters; };
  };
  const std::string whole = first + "; " + middle + "\n" + middle + ". " + last;
  CHECK(shortened(whole, within(whole.size())) == whole);
  CHECK(shortened(whole, within(whole.size() - 1)) == first + " ... " + middle + ". " + last);
  CHECK(shortened(whole, within(70)) == first + " ... " + last);
  CHECK(shortened(whole, within(50)) == first + " ...");
  CHECK(shortened(whole, within(5)) == first + " ...");
  CHECK(shortened(first, within(5)) == first);
}

TEST_CASE("messages: the answer to a click is shown with what the sides say of it, and with the edges") {
  Hands hands = hands_on_sample();
  hands.app.click(hands.app.screen_of(kOnOrange), PointerButton::kLeft);
  REQUIRE(hands.app.settle());
  hands.app.click(hands.app.screen_of(kOnOrange), PointerButton::kRight);
  REQUIRE(hands.app.settle());
  CHECK(hands.said().find(" added and ") != std::string::npos);
  CHECK(hands.said().find("; sides in doubt are marked in the thumbnails") != std::string::npos);
}
