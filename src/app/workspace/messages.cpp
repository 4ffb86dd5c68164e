#include "app/workspace/messages.h"

#include <algorithm>

namespace splatcut {

namespace {

constexpr double kShownSeconds = 7;

// Until somebody has noticed it and read it, at 17 letters a second.
double reading_s(const Message& message) {
  constexpr double kNoticedSeconds = 1, kSecondsPerLetter = 0.06;
  return kNoticedSeconds + kSecondsPerLetter * static_cast<double>(message.text.size());
}

bool warns(const Message& message) {
  return message.kind == Message::Kind::kRefused || message.kind == Message::Kind::kError;
}

// Whether the first is to be read before the second is shown.
bool keeps_off(const Message& shown, const Message& next) {
  return !warns(next) && (warns(shown) || shown.stays);
}

double shown_s(const Message& message) {
  return std::max(kShownSeconds, reading_s(message));
}

}  // namespace

const Message* shown_message(const std::deque<Message>& messages, double now_s) {
  const Message* shown = nullptr;
  // Until `shown` could be read: those that stay, in turn, or the newest of the others.
  std::deque<const Message*> waiting;
  double since_s = 0;
  const auto read_at_s = [&] { return since_s + std::min(reading_s(*shown), kShownSeconds); };
  const auto take_waiting = [&](double at_s) {
    while (!waiting.empty() && read_at_s() <= at_s) {
      since_s = read_at_s();
      shown = waiting.front();
      waiting.pop_front();
    }
  };
  const auto passes = [](const Message* message) { return !message->stays; };
  for (const Message& message : messages) {
    if (message.time_s > now_s) break;
    take_waiting(message.time_s);
    const bool unread = shown && message.time_s < read_at_s();
    if (unread && keeps_off(*shown, message)) {
      if (message.stays || std::ranges::all_of(waiting, passes)) {
        std::erase_if(waiting, passes);
        waiting.push_back(&message);
      }
      continue;
    }
    std::erase_if(waiting, passes);
    if (unread && shown->stays) waiting.push_front(shown);  // it comes back behind a warning
    shown = &message;
    since_s = message.time_s;
  }
  take_waiting(now_s);
  return shown && now_s - since_s <= shown_s(*shown) ? shown : nullptr;
}

bool add_to_shown(Message::Kind kind, const std::string& text, double now_s, std::deque<Message>* messages) {
  if (messages->empty() || shown_message(*messages, now_s) != &messages->back()) return false;
  Message& last = messages->back();
  const std::string whose = text.substr(0, text.find(": ") + 2);  // said once
  const bool same = text.find(": ") != std::string::npos && last.text.starts_with(whose);
  const std::string more = same ? text.substr(whose.size()) : text;
  if (last.text.ends_with(more)) return true;
  last.text += (same ? "; " : "\n") + more;
  last.kind = std::max(kind, last.kind == Message::Kind::kDone ? Message::Kind::kInfo : last.kind);
  last.time_s = now_s;
  return true;
}

namespace {

// Where the sentence or line that begins at `from` ends, with the blank behind it.
std::size_t end_of_piece(const std::string& text, std::size_t from) {
  const std::size_t stop = std::min({text.find(". ", from), text.find("; ", from), text.find('\n', from)});
  if (stop == std::string::npos) return text.size();
  return stop + (text[stop] == '\n' ? 1 : 2);
}

}  // namespace

std::string shortened(const std::string& text, const std::function<bool(const std::string&)>& fits) {
  const std::size_t first_end = end_of_piece(text, 0);
  if (fits(text) || first_end == text.size()) return text;
  std::string first = text.substr(0, first_end);
  first.erase(first.find_last_not_of(" ;\n") + 1);
  for (std::size_t from = end_of_piece(text, first_end); from < text.size(); from = end_of_piece(text, from))
    if (const std::string shown = first + " ... " + text.substr(from); fits(shown)) return shown;
  return first + " ...";
}

}  // namespace splatcut
