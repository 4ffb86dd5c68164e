// splatcut serve: requests on stdin, replies on stdout, until stdin ends.
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <csignal>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/serve_conversation.h"
#include "app/cli/serve_mailbox.h"
#include "app/console/console.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

// Tells how far a request is, at most ten times a second, so that a quick one says nothing.
std::function<void(std::string_view, double)> progress_of(const nlohmann::json& id, ReplyWriter* replies) {
  using Clock = std::chrono::steady_clock;
  static constexpr auto kBetween = std::chrono::milliseconds(100);
  return [id, replies, last = Clock::now()](std::string_view stage, double fraction) mutable {
    if (Clock::now() - last < kBetween) return;
    last = Clock::now();
    replies->progress(id, stage, fraction);
  };
}

void answer(const WaitingRequest& waiting, Conversation* conversation, ReplyWriter* replies) {
  try {
    if (!waiting.error.empty()) return replies->refuse(waiting.id, waiting.error);
    const Job job{waiting.stop.get_token(), progress_of(waiting.id, replies)};
    if (job.cancelled()) throw Error("request", "was cancelled, nothing was changed");
    replies->reply(waiting.id, conversation->answer(waiting.request, job));
  } catch (const std::exception& error) {
    replies->refuse(waiting.id, sentence_of(error));
  }
}

void run_serve(const CommonOptions& common) {
  std::signal(SIGPIPE, SIG_IGN);  // a client that is gone ends the conversation
  const Job console = console_job(true);
  ReplyWriter replies(STDOUT_FILENO, console.stop);
  Mailbox mailbox(STDIN_FILENO, &replies, console.stop);
  Conversation conversation(prepared_cache(common));
  while (!conversation.ended() && !replies.broken()) {
    std::optional<WaitingRequest> waiting = mailbox.next();
    if (!waiting) break;
    const std::stop_callback on_signal(console.stop, [&] { waiting->stop.request_stop(); });
    answer(*waiting, &conversation, &replies);
  }
  if (console.cancelled()) throw Error("splatcut serve", "was ended by a signal");
  if (replies.broken()) throw Error("splatcut serve", "nobody reads the replies any more");
}

}  // namespace

void add_serve_command(CLI::App& program, const CommonOptions& common) {
  auto schema = std::make_shared<bool>(false);
  CLI::App& command =
      *program.add_subcommand("serve", "Answer requests in JSON, a line each, on stdin and stdout");
  command.footer("Example: splatcut serve --schema");
  command.add_flag("--schema", *schema, "Print which requests there are, as a JSON Schema, and end");
  command.callback([schema, &common] {
    if (*schema)
      fmt::print("{}\n", json_text(request_schema(), 2));
    else
      run_serve(common);
  });
}

}  // namespace splatcut
