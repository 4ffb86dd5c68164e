// Requests as they come in on a thread of their own: in order, each answered once, and cancelled from beside.
#include "app/cli/serve_mailbox.h"

#include <unistd.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base64.h"
#include "quick.h"

using namespace splatcut;
using nlohmann::json;

namespace {

// What a client would hold of two pipes.
class Client {
 public:
  Client() {
    REQUIRE(::pipe(to_) == 0);
    REQUIRE(::pipe(from_) == 0);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() {
    for (const int end : {to_[0], to_[1], from_[0], from_[1]}) ::close(end);
  }
  int input() const { return to_[0]; }
  int output() const { return from_[1]; }
  void say(const std::string& bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t n = ::write(to_[1], bytes.data() + sent, bytes.size() - sent);
      REQUIRE(n > 0);
      sent += static_cast<std::size_t>(n);
    }
  }
  void end() { ::close(std::exchange(to_[1], ::dup(from_[0]))); }
  json hear() {
    std::string line;
    for (char c = 0; ::read(from_[0], &c, 1) == 1 && c != '\n';) line += c;
    return json::parse(line);
  }

 private:
  int to_[2] = {-1, -1}, from_[2] = {-1, -1};
};

}  // namespace

QUICK_CASE("mailbox",
           "mailbox: requests in their order, lines that are none among them, pieces of lines joined") {
  Client client;
  ReplyWriter replies(client.output());
  Mailbox mailbox(client.input(), &replies, {});
  client.say("{\"id\": 1, \"do\": \"undo\"}\n\n  \r\n{\"id\": \"two\", \"do\"");
  CHECK(mailbox.next()->id == 1);
  client.say(": \"undo\"}\nnonsense\n[]\n{\"id\": [1], \"do\": \"quit\"}");
  CHECK(mailbox.next()->id == "two");
  const auto nonsense = mailbox.next();
  CHECK(nonsense->error == "request: this is not valid JSON at byte 2.");
  CHECK(nonsense->id.is_null());
  CHECK(mailbox.next()->request == json::array());
  client.end();  // the last line has no end of its own
  const auto last = mailbox.next();
  REQUIRE(last);
  CHECK(last->request["do"] == "quit");
  CHECK(last->id.is_null());  // a list is no id
  CHECK_FALSE(mailbox.next());
  CHECK_FALSE(mailbox.next());
}

QUICK_CASE("mailbox", "mailbox: what runs and what waits is cancelled at once, what is not there is not") {
  Client client;
  ReplyWriter replies(client.output());
  Mailbox mailbox(client.input(), &replies, {});
  client.say("{\"id\": 1, \"do\": \"undo\"}\n{\"id\": 2, \"do\": \"undo\"}\n{\"id\": 3, \"do\": \"undo\"}\n");
  const auto first = mailbox.next();
  CHECK_FALSE(first->stop.stop_requested());
  client.say(
      "{\"id\": \"c\", \"do\": \"cancel\", \"request\": 1}\n{\"id\": \"d\", \"do\": \"cancel\", \"request\": "
      "3}\n");
  CHECK(client.hear() == json{{"id", "c"}, {"ok", true}, {"cancelled", true}});
  CHECK(client.hear() == json{{"id", "d"}, {"ok", true}, {"cancelled", true}});
  CHECK(first->stop.stop_requested());
  CHECK_FALSE(mailbox.next()->stop.stop_requested());
  CHECK(mailbox.next()->stop.stop_requested());
  client.say("{\"do\": \"cancel\", \"request\": 1}\n");
  CHECK(client.hear() == json{{"id", nullptr}, {"ok", true}, {"cancelled", false}});
}

QUICK_CASE("mailbox", "mailbox: a line without end is refused once, and is not kept") {
  Client client;
  ReplyWriter replies(client.output());
  Mailbox mailbox(client.input(), &replies, {});
  const std::string piece(1 << 16, '[');
  for (std::size_t sent = 0; sent <= Mailbox::kMostBytes; sent += piece.size()) client.say(piece);
  client.say("\n{\"id\": 5, \"do\": \"undo\"}\n");
  CHECK(mailbox.next()->error.find("longer than") != std::string::npos);
  CHECK(mailbox.next()->id == 5);
}

QUICK_CASE("mailbox", "mailbox: a stop ends the wait, whether requests are read, waited for or waiting") {
  for (const int waiting : {0, 1, 3000}) {
    Client client;
    std::stop_source stop;
    ReplyWriter replies(client.output());
    Mailbox mailbox(client.input(), &replies, stop.get_token());
    for (int i = 0; i < waiting; ++i) client.say("{\"id\": 1, \"do\": \"undo\"}\n");
    std::thread later([&] { stop.request_stop(); });
    while (mailbox.next()) continue;
    later.join();
  }
}

QUICK_CASE("requests", "base64: the examples of RFC 4648") {
  const std::vector<std::pair<std::string, std::string>> examples = {
      {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}, {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : examples) CHECK(base64_of(bytes) == text);
  CHECK(base64_of("\xff\xef\xbe") == "/+++");
}

QUICK_CASE("mailbox", "replies: lines of several threads are whole, and a client that is gone is noticed") {
  Client client;
  ReplyWriter replies(client.output());
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 50; ++i) replies.progress(t, "stage", 0.5);
    });
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < 200; ++i) CHECK(client.hear()["fraction"] == 0.5);
  CHECK_FALSE(replies.broken());
  constexpr int kNone = 1 << 20;
  ReplyWriter gone(kNone);
  gone.reply(1, {});
  CHECK(gone.broken());
}

QUICK_CASE("mailbox", "replies: a stop ends the wait for a client that does not read") {
  const Client client;
  std::stop_source stop;
  ReplyWriter replies(client.output(), stop.get_token());
  constexpr std::size_t kMoreThanAPipeHolds = 1 << 20;
  std::thread writer([&] { replies.reply(1, {{"text", std::string(kMoreThanAPipeHolds, 'a')}}); });
  stop.request_stop();
  writer.join();
  CHECK(replies.broken());
}
