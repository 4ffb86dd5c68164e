#include "app/work/left_work.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>

#include "app/document/words.h"
#include "app/work/work_file.h"
#include "app/work/work_picture.h"
#include "core/error.h"

namespace splatcut {

LeftWork left_work(const std::filesystem::path& work) {
  std::error_code ignored;  // it may go in this moment
  const auto written = std::chrono::file_clock::to_sys(std::filesystem::last_write_time(work, ignored));
  const std::time_t seconds = std::chrono::system_clock::to_time_t(
      std::chrono::time_point_cast<std::chrono::system_clock::duration>(written));
  const std::tm then = fmt::localtime(seconds), now = fmt::localtime(std::time(nullptr));
  const bool today = then.tm_year == now.tm_year && then.tm_yday == now.tm_yday;
  const std::string when = today ? fmt::format("{:%H:%M}", then) : fmt::format("{:%Y-%m-%d}", then);
  try {
    const WorkFile file = read_work_file(work);
    const std::filesystem::path scene = file.files.front().path;
    LeftWork left{work, scene, fmt::format("{}  {}", when, name_in_folder(scene)), read_work_picture(work)};
    left.nothing = file.holds_nothing();
    return left;
  } catch (const Error&) {
    return {work, {}, when};  // what is wrong with it is said when it is restored
  }
}

}  // namespace splatcut
