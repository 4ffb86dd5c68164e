#include "app/cli/serve_mailbox.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <utility>

#include "app/cli/serve_requests.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

constexpr int kLookMs = 100;  // between looks whether to stop

// What a reply is told apart by: text or a whole number, else nothing.
nlohmann::json id_of(const nlohmann::json& request) {
  if (!request.is_object() || !request.contains("id")) return {};
  const nlohmann::json& id = request.at("id");
  return is_id(id) ? id : nlohmann::json();
}

// The id that a request to cancel names; none for other requests, and for one that is wrong.
std::optional<nlohmann::json> cancelled_by(const WaitingRequest& waiting) {
  if (!waiting.error.empty() || !waiting.request.is_object() ||
      waiting.request.value("do", nlohmann::json()) != "cancel")
    return {};
  try {
    checked_kind(waiting.request);
    return waiting.request.at("request");
  } catch (const Error&) {
    return {};
  }
}

WaitingRequest request_of_line(std::string_view line) {
  WaitingRequest waiting;
  try {
    waiting.request = request_from(line);
    waiting.id = id_of(waiting.request);
  } catch (const std::exception& error) {
    waiting.error = sentence_of(error);
  }
  return waiting;
}

}  // namespace

// A pipe that has room has it for so much: nobody who does not read keeps us from seeing a stop.
void ReplyWriter::line(const nlohmann::json& line) {
  constexpr std::size_t kMostAtOnce = PIPE_BUF;
  const std::string text = json_text(line) + "\n";
  const std::lock_guard lock(mutex_);
  for (std::size_t sent = 0; sent < text.size() && !broken_;) {
    pollfd there{output_, POLLOUT, 0};
    if (::poll(&there, 1, kLookMs) <= 0) {
      broken_ = stop_.stop_requested();
      continue;
    }
    const ssize_t n = ::write(output_, text.data() + sent, std::min(kMostAtOnce, text.size() - sent));
    if (n >= 0)
      sent += static_cast<std::size_t>(n);
    else if (errno != EINTR)
      broken_ = true;
  }
}

void ReplyWriter::reply(const nlohmann::json& id, nlohmann::json fields) {
  fields.update({{"id", id}, {"ok", true}});
  line(fields);
}

void ReplyWriter::refuse(const nlohmann::json& id, const std::string& sentence) {
  line({{"id", id}, {"ok", false}, {"error", sentence}});
}

void ReplyWriter::progress(const nlohmann::json& id, std::string_view stage, double fraction) {
  line({{"id", id}, {"progress", stage}, {"fraction", fraction}});
}

Mailbox::Mailbox(int input, ReplyWriter* replies, std::stop_token stop)
    : replies_(replies), stop_(std::move(stop)), reader_([this, input] { read(input); }) {}

Mailbox::~Mailbox() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  reader_.join();
}

std::optional<WaitingRequest> Mailbox::next() {
  std::unique_lock lock(mutex_);
  running_.reset();
  const bool asked = changed_.wait(lock, stop_, [&] { return ended_ || !waiting_.empty(); });
  if (!asked || waiting_.empty()) return {};
  WaitingRequest request = std::move(waiting_.front());
  waiting_.pop_front();
  running_ = request.stop;
  running_id_ = request.id;
  changed_.notify_all();  // there is room again
  return request;
}

void Mailbox::read(int input) {
  std::array<char, 1 << 16> bytes{};
  const auto closed = [&] {
    const std::lock_guard lock(mutex_);
    return closed_ || stop_.stop_requested();
  };
  while (!closed()) {
    pollfd there{input, POLLIN, 0};
    if (::poll(&there, 1, kLookMs) <= 0) continue;
    const ssize_t n = ::read(input, bytes.data(), bytes.size());
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (n <= 0) break;
    take({bytes.data(), static_cast<std::size_t>(n)});
  }
  if (!line_.empty() || too_long_) take("\n");
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

void Mailbox::take(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    const std::string_view piece = bytes.substr(0, end);
    too_long_ = too_long_ || line_.size() + piece.size() > kMostBytes;
    if (!too_long_) line_ += piece;
    if (end == bytes.npos) return;
    bytes.remove_prefix(end + 1);
    const std::string line = std::exchange(line_, {});
    if (std::exchange(too_long_, false)) {
      WaitingRequest refused;
      refused.error = sentence_of(Error("request", fmt::format("is longer than {} bytes", kMostBytes)));
      put(std::move(refused));
    } else if (line.find_first_not_of(" \t\r") != line.npos) {
      put(request_of_line(line));
    }
  }
}

void Mailbox::put(WaitingRequest request) {
  if (const auto id = cancelled_by(request)) {
    replies_->reply(request.id, {{"cancelled", cancel(*id)}});
    return;
  }
  std::unique_lock lock(mutex_);
  changed_.wait(lock, stop_, [&] { return closed_ || waiting_.size() < kMostWaiting; });
  waiting_.push_back(std::move(request));
  changed_.notify_all();
}

bool Mailbox::cancel(const nlohmann::json& id) {
  const std::lock_guard lock(mutex_);
  if (running_ && running_id_ == id) return running_->request_stop(), true;
  const auto waiting = std::ranges::find(waiting_, id, &WaitingRequest::id);
  return waiting != waiting_.end() && (waiting->stop.request_stop(), true);
}

}  // namespace splatcut
