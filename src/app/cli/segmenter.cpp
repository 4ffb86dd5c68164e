#include "app/cli/segmenter.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include "app/console/mask_folder.h"
#include "app/console/run_program.h"
#include "core/error.h"
#include "core/png_file.h"
#include "scene/raster/rasterizer.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

constexpr const char* kHowToName =
    "Give --segmenter 'PROGRAM {image} {text} {mask}', or set SPLATCUT_SEGMENTER to that";

// Locked while it is used: what a killed process leaves has no lock, and the next one removes it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code failure;
    const fs::path place = fs::temp_directory_path(failure);
    remove_left(place);
    std::string name = (place / (std::string(kName) + "XXXXXX")).string();
    if (failure || !::mkdtemp(name.data()))
      throw Error(name, "cannot be created", "TMPDIR says where temporary files go");
    path_ = name;
    held_ = hold(path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    ::close(held_);
  }
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  static constexpr std::string_view kName = "splatcut_segmenter_";

  // -1 where another process holds it.
  static int hold(const fs::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
    ::close(descriptor);
    return -1;
  }
  // Not younger than a minute: it may not be held yet.
  static void remove_left(const fs::path& place) {
    constexpr std::chrono::minutes kYoung(1);
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(place, ignored)) {
      if (!entry.path().filename().string().starts_with(kName)) continue;
      const auto age = fs::file_time_type::clock::now() - entry.last_write_time(ignored);
      const int held = age > kYoung ? hold(entry.path()) : -1;
      if (held < 0) continue;
      fs::remove_all(entry.path(), ignored);
      ::close(held);
    }
  }

  fs::path path_;
  int held_ = -1;
};

std::vector<std::string> split_command(const std::string& command) {
  std::vector<std::string> words;
  std::string word;
  char quote = 0;
  bool in_word = false;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const char c = command[i];
    const bool blank = c == ' ' || c == '\t' || c == '\n';
    if (c == '\\' && quote != '\'' && i + 1 < command.size()) {
      word += command[++i];
      in_word = true;
    } else if (quote ? c == quote : (c == '\'' || c == '"')) {
      quote = quote ? 0 : c;
      in_word = true;  // '' is an empty word
    } else if (blank && !quote) {
      if (in_word) words.push_back(std::exchange(word, {}));
      in_word = false;
    } else {
      word += c;
      in_word = true;
    }
  }
  if (command.find('\0') != command.npos) throw Error("--segmenter", "holds a zero byte", kHowToName);
  if (quote) throw Error("--segmenter", fmt::format("a quote {} has no end", quote), kHowToName);
  if (in_word) words.push_back(word);
  return words;
}

struct Placeholder {
  std::string name, value;
};

// In one pass: inserted text is not substituted again.
std::string filled(const std::string& word, const std::vector<Placeholder>& placeholders) {
  std::string out;
  for (std::size_t i = 0; i < word.size();) {
    const auto here = std::ranges::find_if(
        placeholders, [&](const Placeholder& p) { return word.compare(i, p.name.size(), p.name) == 0; });
    if (here == placeholders.end()) {
      out += word[i++];
      continue;
    }
    out += here->value;
    i += here->name.size();
  }
  return out;
}

void check_end(const ProgramEnd& end, const std::string& program) {
  if (end.start_error != 0)
    throw Error(program, fmt::format("the segmenter cannot be started ({})", std::strerror(end.start_error)),
                "See whether it is installed, executable and on the PATH");
  if (end.signal != 0)
    throw Error(program, fmt::format("the segmenter was ended by signal {}", end.signal),
                "Try its command by hand");
  if (end.exit_code != 0)
    throw Error(program, fmt::format("the segmenter failed with exit code {}", end.exit_code),
                "What it printed says why; try its command by hand");
}

ReadMask read_answer(const fs::path& mask, const std::string& program) {
  std::error_code ignored;
  if (!fs::exists(mask, ignored))
    throw Error(program, "the segmenter wrote no mask",
                "It must write a PNG to the path it is given as {mask}");
  try {
    return read_mask(mask);
  } catch (const Error&) {
    throw Error(program, "the segmenter's mask is not a whole picture",
                "It must write a PNG to the path it is given as {mask}");
  }
}

}  // namespace

Segmenter make_segmenter(const SegmenterOptions& options) {
  std::string command = options.command;
  if (const char* kept = std::getenv("SPLATCUT_SEGMENTER"); command.empty() && kept) command = kept;
  Segmenter segmenter{options.text, split_command(command)};
  if (segmenter.text.empty()) throw Error("--text", "is empty", "Say what is to be cut out");
  if (segmenter.words.empty())
    throw Error("--text", "needs a program that finds words in a picture, and none is named", kHowToName);
  for (const char* placeholder : {"{image}", "{text}", "{mask}"})
    if (std::ranges::none_of(segmenter.words, [&](const std::string& word) {
          return word.find(placeholder) != std::string::npos;
        }))
      throw Error("--segmenter", fmt::format("{} is missing", placeholder), kHowToName);
  return segmenter;
}

Mask mask_from_text(const Segmenter& segmenter, const GaussianCloud& cloud, const Camera& camera,
                    const Job& job) {
  const TemporaryFolder folder;
  const fs::path image = folder / "image.png", mask = folder / "mask.png";
  const RasterOutput picture = rasterize(cloud, camera, {}, job);
  if (job.cancelled()) return {};
  write_png(image, rgb8_from_linear(picture.colour));
  std::vector<std::string> words;
  for (const std::string& word : segmenter.words)
    words.push_back(
        filled(word, {{"{image}", image.string()}, {"{text}", segmenter.text}, {"{mask}", mask.string()}}));
  const ProgramEnd end = run_program(words, job);
  if (job.cancelled()) return {};
  const std::string& program = words.front();
  check_end(end, program);
  ReadMask answer = read_answer(mask, program);
  if (answer.how.empty())
    throw Error(program, "the segmenter found nothing: its mask is black",
                "Try other words, or another view");
  return checked_mask(std::move(answer), camera, program);
}

}  // namespace splatcut
