#include "app/work/native_dialog.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "app/console/run_program.h"

namespace splatcut {

namespace {

std::string patterns(const FileQuestion& question) {
  std::string out;
  for (const std::string& e : question.extensions) out += (out.empty() ? "*" : " *") + e;
  return out.empty() ? "*" : out;
}

}  // namespace

std::vector<std::string> native_dialog_command(const FileQuestion& question) {
  const std::string start = question.start.string();
  if (on_path("zenity")) {
    std::vector<std::string> command = {"zenity", "--file-selection", "--title=" + question.title,
                                        "--filename=" + start + (question.saving ? "" : "/")};
    if (question.saving)
      command.insert(command.end(), {"--save", "--confirm-overwrite"});
    else
      command.push_back("--file-filter=" + patterns(question));
    return command;
  }
  if (on_path("kdialog"))
    return {"kdialog",      "--title",
            question.title, question.saving ? "--getsavefilename" : "--getopenfilename",
            start,          patterns(question)};
  return {};
}

NativeDialog::~NativeDialog() {
  close();
}

void NativeDialog::close() {
  if (output_ >= 0) ::close(output_);
  if (child_ > 0) {
    ::kill(child_, SIGTERM);
    ::waitpid(child_, nullptr, 0);
  }
  output_ = -1;
  child_ = -1;
}

bool NativeDialog::ask(const FileQuestion& question) {
  close();
  text_.clear();
  const std::vector<std::string> command = native_dialog_command(question);
  int ends[2];
  if (command.empty() || ::pipe2(ends, O_CLOEXEC) != 0) return false;
  const int failed = start_program(command, ends[1], {}, &child_);
  ::close(ends[1]);
  output_ = ends[0];
  ::fcntl(output_, F_SETFL, O_NONBLOCK);
  if (failed) child_ = -1, close();
  return !failed;
}

NativeDialog::State NativeDialog::poll() {
  if (child_ <= 0) return State::kClosed;
  int status = 0;
  const bool ended = ::waitpid(child_, &status, WNOHANG) == child_;
  char buffer[4096];
  for (ssize_t n = 0; (n = ::read(output_, buffer, sizeof(buffer))) > 0;)
    text_.append(buffer, static_cast<std::size_t>(n));
  if (!ended) return State::kOpen;
  child_ = -1;
  close();
  while (!text_.empty() && text_.back() == '\n') text_.pop_back();
  path_ = text_;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && !text_.empty()) return State::kChosen;
  return WIFEXITED(status) && WEXITSTATUS(status) <= 1 ? State::kCancelled : State::kFailed;
}

}  // namespace splatcut
