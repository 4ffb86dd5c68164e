// The requests of a client as they come in, line by line on a thread of their own, and the replies to it.
//
// So a request that runs or waits can be cancelled by one that comes after it. Every line is answered once; a
// line that is no request waits its turn like others, so that replies keep the order of the lines, those to
// cancel apart. Lines beyond kMostBytes are refused without being kept, and with kMostWaiting requests no
// more are read until one is done.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace splatcut {

// Lines to a client, whole, from any thread. A stop ends the wait for one who does not read.
class ReplyWriter {
 public:
  explicit ReplyWriter(int output, std::stop_token stop = {}) : output_(output), stop_(std::move(stop)) {}

  void reply(const nlohmann::json& id, nlohmann::json fields);         // {"id", "ok": true, ...}
  void refuse(const nlohmann::json& id, const std::string& sentence);  // {"id", "ok": false, "error"}
  void progress(const nlohmann::json& id, std::string_view stage, double fraction);
  bool broken() const { return broken_; }  // nobody reads any more

 private:
  void line(const nlohmann::json& line);

  int output_;
  std::stop_token stop_;
  std::mutex mutex_;
  std::atomic<bool> broken_ = false;
};

struct WaitingRequest {
  nlohmann::json request, id;
  std::string error;  // why the line is no request
  std::stop_source stop{};
};

class Mailbox {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{4} << 20, kMostWaiting = 1000;

  // Reads from the descriptor until its end, or until `stop` asks for it.
  Mailbox(int input, ReplyWriter* replies, std::stop_token stop);
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;
  ~Mailbox();

  // Waits for the next one, which runs until the next call; none: the input has ended, or stop was asked for.
  std::optional<WaitingRequest> next();

 private:
  void read(int input);
  void take(std::string_view bytes);
  void put(WaitingRequest request);
  bool cancel(const nlohmann::json& id);

  ReplyWriter* replies_;
  std::stop_token stop_;
  std::string line_;  // so far
  bool too_long_ = false;

  std::mutex mutex_;  // of what follows
  std::condition_variable_any changed_;
  std::deque<WaitingRequest> waiting_;
  nlohmann::json running_id_;
  std::optional<std::stop_source> running_;
  bool ended_ = false, closed_ = false;

  std::thread reader_;  // last: it needs all of them
};

}  // namespace splatcut
