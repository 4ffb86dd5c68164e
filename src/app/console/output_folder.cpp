#include "app/console/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "core/error.h"

namespace splatcut {

namespace {

namespace fs = std::filesystem;

// 0 where there is none.
std::uint64_t inode_of(const fs::path& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

std::vector<fs::path> names_in(const fs::path& folder, const char* remedy = "") {
  std::vector<fs::path> names;
  std::error_code failure;
  for (fs::directory_iterator at(folder, failure), end; !failure && at != end; at.increment(failure))
    names.push_back(at->path().filename());
  if (failure) throw Error(folder.string(), "cannot be read (" + failure.message() + ")", remedy);
  return names;
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code failure;
  fs::rename(from, to, failure);
  if (failure)
    throw Error(to.string(), fmt::format("cannot be written ({}), it lies in {}", failure.message(),
                                         from.parent_path().string()));
}

// No link to one.
bool is_folder(const fs::path& path) {
  std::error_code failure;
  return fs::is_directory(fs::symlink_status(path, failure));
}

bool are_folders(const fs::path& a, const fs::path& b) {
  return is_folder(a) && is_folder(b);
}

void make_folder(const fs::path& folder, const fs::path& meant) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw Error(meant.string(), "cannot be created (" + failure.message() + ")");
}

// A shell that stands in the folder, and a mount point, want it to stay the one it is.
bool can_be_exchanged(const fs::path& folder) {
  struct stat own {};
  struct stat parent {};
  std::error_code failure;
  return ::stat(folder.c_str(), &own) == 0 && ::stat(folder.parent_path().c_str(), &parent) == 0 &&
         own.st_dev == parent.st_dev && ::access(folder.parent_path().c_str(), W_OK) == 0 &&
         folder != fs::current_path(failure);
}

bool exchanged(const fs::path& a, const fs::path& b) {
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

// Throws Error where a file would take the place of a folder, or the other way round.
void refuse_other_kinds(const fs::path& from, const fs::path& to, const fs::path& meant) {
  for (const fs::path& name : names_in(from)) {
    if (is_folder(to / name) && !is_folder(from / name))
      throw Error((meant / name).string(), "is a folder, where a file is to be written");
    if (inode_of(to / name) != 0 && is_folder(from / name) && !is_folder(to / name))
      throw Error((meant / name).string(), "is no folder, where a folder is to be written");
    if (are_folders(from / name, to / name)) refuse_other_kinds(from / name, to / name, meant / name);
  }
}

// So that they are there at the moment of the exchange; folders cannot be linked and come after it.
void link_other_files(const fs::path& from, const fs::path& to) {
  for (const fs::path& name : names_in(from))
    if (are_folders(from / name, to / name))
      link_other_files(from / name, to / name);
    else if (inode_of(to / name) == 0)
      ::link((from / name).c_str(), (to / name).c_str());
}

// From the folder that was replaced. Files whose place is taken are older ones of ours.
void bring_back(const fs::path& from, const fs::path& to) {
  constexpr const char* kRemedy =
      "The output is written; what others had in it lies there, and the next run brings it back";
  for (const fs::path& name : names_in(from, kRemedy))
    if (inode_of(to / name) == 0) move(from / name, to / name);
  std::error_code failure;
  for (const fs::path& name : names_in(from, kRemedy))
    if (are_folders(from / name, to / name))
      bring_back(from / name, to / name);
    else if (!fs::remove(from / name, failure))
      throw Error((from / name).string(), "cannot be removed (" + failure.message() + ")",
                  "It is left of an earlier run; move what is yours to another place");
  fs::remove(from, failure);
}

// What replaces something is on the disk before it does.
void wait_for_files(const fs::path& folder, const fs::path& meant) {
  for (const fs::path& name : names_in(folder))
    if (is_folder(folder / name))
      wait_for_files(folder / name, meant);
    else
      wait_for_disk(folder / name, meant);
  wait_for_disk(folder, meant);
}

// Of what these replace.
void take_permissions(const fs::path& fresh, const fs::path& target) {
  std::error_code failure;
  for (const fs::path& name : names_in(fresh)) {
    const bool folders = are_folders(fresh / name, target / name);
    if (folders) take_permissions(fresh / name, target / name);
    if (folders || fs::is_regular_file(fs::symlink_status(target / name, failure)))
      make_like(target / name, fresh / name);
  }
}

void move_each(const fs::path& from, const fs::path& to) {
  for (const fs::path& name : names_in(from))
    if (are_folders(from / name, to / name))
      move_each(from / name, to / name);
    else
      move(from / name, to / name);
  std::error_code ignored;
  fs::remove(from, ignored);
}

fs::path resolved(fs::path path) {
  if (path.empty()) throw Error("--output", "its name is empty", "Name the folder to write");
  if (path.filename().empty()) path = path.parent_path();
  std::error_code failure;
  const fs::path target = fs::weakly_canonical(fs::absolute(behind_links(path)), failure);
  if (failure) throw Error(path.string(), "cannot be reached (" + failure.message() + ")");
  return target;
}

}  // namespace

void refuse_existing(const fs::path& path, bool overwrite, const char* remedy) {
  std::error_code failure;
  if (!overwrite && fs::exists(path, failure)) throw Error(path.string(), "exists already", remedy);
}

void check_output_file(const fs::path& path, bool overwrite, const char* remedy) {
  if (!is_stream(path)) refuse_existing(path, overwrite, remedy);
}

OutputFolder::OutputFolder(const fs::path& path, bool overwrite)
    : path_(path), target_(resolved(path)), overwrite_(overwrite) {
  refuse_existing(target_, overwrite_);
  std::error_code failure;
  const fs::file_type there = fs::status(target_, failure).type();
  if (fs::exists(fs::file_status(there)) && there != fs::file_type::directory)
    throw Error(path_.string(), "is a file, where a folder is to be written");
  exchangeable_ = there != fs::file_type::directory || can_be_exchanged(target_);
  const fs::path ours = exchangeable_ ? target_ : target_ / "";
  for (fs::path above = ours.parent_path(); inode_of(above) == 0; above = above.parent_path())
    made_.push_back(above);
  make_folder(ours.parent_path(), path_);
  lock_.emplace(fs::path(ours) += ".splatcut.part", path_);
  fresh_ = fs::path(ours) += ".splatcut.new";
  set_right();
  refuse_existing(target_, overwrite_);  // another process may have come first
  make_folder(fresh_, path_);
  const std::uint64_t number = inode_of(fresh_);
  const auto noted = [&] {
    return ::pwrite(lock_->descriptor(), &number, sizeof number, 0) == sizeof number;
  };
  if (!noted() && !noted()) {  // a write may take a part
    ::rmdir(fresh_.c_str());   // no destructor will
    throw Error(path_.string(), "cannot be written", "Make room there, or choose another place");
  }
}

OutputFolder::~OutputFolder() {
  remove_unfinished();
  lock_.reset();
  for (const fs::path& folder : made_) ::rmdir(folder.c_str());  // those alone that are empty
}

std::vector<std::string> OutputFolder::names() const {
  std::vector<std::string> names;
  for (const fs::path& name : names_in(fresh_)) names.push_back(name.string());
  std::ranges::sort(names);
  return names;
}

std::uint64_t OutputFolder::number_in_lock() const {
  std::uint64_t number = 0;
  return ::pread(lock_->descriptor(), &number, sizeof number, 0) == sizeof number ? number : 0;
}

// By its number: after an exchange the name is that of the folder that was replaced.
void OutputFolder::remove_unfinished() {
  std::error_code ignored;
  if (inode_of(fresh_) != 0 && inode_of(fresh_) == number_in_lock()) fs::remove_all(fresh_, ignored);
}

void OutputFolder::set_right() {
  remove_unfinished();
  ::rmdir(fresh_.c_str());  // an empty one: its maker was killed before its number was noted
  if (inode_of(fresh_) == 0) return;
  make_folder(target_, path_);
  bring_back(fresh_, target_);
}

void OutputFolder::commit() {
  refuse_existing(target_, overwrite_);
  if (inode_of(target_) == 0) return move(fresh_, target_);
  refuse_other_kinds(fresh_, target_, path_);
  wait_for_files(fresh_, path_);
  take_permissions(fresh_, target_);
  if (!exchangeable_) return move_each(fresh_, target_);
  make_like(target_, fresh_);
  link_other_files(target_, fresh_);
  if (!exchanged(fresh_, target_)) return move_each(fresh_, target_);
  bring_back(fresh_, target_);
}

}  // namespace splatcut
