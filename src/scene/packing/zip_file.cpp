#include "scene/packing/zip_file.h"

#include <fmt/format.h>
#include <zip.h>

#include <filesystem>
#include <new>

#include "core/error.h"
#include "scene/packing/unpack.h"

namespace splatcut {

namespace {

void refuse_without_memory(zip_error_t* failure) {
  if (zip_error_code_zip(failure) == ZIP_ER_MEMORY) throw std::bad_alloc();
}

// Throws std::bad_alloc where it was that.
std::string words_of(zip_error_t& failure) {
  refuse_without_memory(&failure);
  std::string words = zip_error_strerror(&failure);
  zip_error_fini(&failure);
  return words;
}

}  // namespace

ZipReader::ZipReader(const MappedFile& file) : file_(file), archive_(nullptr, zip_discard) {
  zip_error_t failure;
  zip_error_init(&failure);
  zip_source_t* source = zip_source_buffer_create(file.bytes().data(), file.bytes().size(), 0, &failure);
  if (source) archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &failure));
  if (archive_) return;
  if (source) zip_source_free(source);
  throw Error(file.path().string(),
              fmt::format("is truncated or damaged: it cannot be read as ZIP ({})", words_of(failure)));
}

std::string ZipReader::find(const std::string& name) const {
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* entry = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
    const std::string_view path = entry ? entry : "";
    const bool of_macos = path.starts_with("__MACOSX/");  // what the Finder adds
    if (!of_macos && path.substr(path.rfind('/') + 1) == name) return std::string(path);
  }
  return {};
}

std::vector<std::byte> ZipReader::read(const std::string& path) const {
  const auto refuse = [&](const char* what) {
    throw Error(file_.path().string(), fmt::format("the file {} in it {}", path, what));
  };
  zip_stat_t about;
  if (zip_stat(archive_.get(), path.c_str(), 0, &about) != 0) refuse("is missing");
  if (!(about.valid & ZIP_STAT_SIZE)) refuse("does not say its size");
  check_expansion(file_.path(), file_.bytes().size(), about.size);
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> entry(
      zip_fopen_index(archive_.get(), about.index, 0), zip_fclose);
  if (!entry) refuse_without_memory(zip_get_error(archive_.get()));
  std::vector<std::byte> bytes(about.size);
  if (!entry || zip_fread(entry.get(), bytes.data(), bytes.size()) != static_cast<zip_int64_t>(bytes.size()))
    refuse("is truncated or damaged");
  std::byte beyond;  // the checksum is compared at the end
  if (zip_fread(entry.get(), &beyond, 1) != 0) refuse("is damaged: its checksum differs");
  return bytes;
}

std::vector<std::byte> zip_of(std::span<const ZipEntry> entries) {
  zip_error_t failure;
  zip_error_init(&failure);
  zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, &failure);
  zip_t* archive = target ? zip_open_from_source(target, ZIP_TRUNCATE, &failure) : nullptr;
  if (!archive) throw Error("zip", "the ZIP writer failed to start: " + words_of(failure));
  zip_source_keep(target);  // outlives the archive
  const std::unique_ptr<zip_source_t, void (*)(zip_source_t*)> owner(target, zip_source_free);
  constexpr zip_uint16_t kFirstDay = 1 << 5 | 1;  // 1980-01-01, the earliest that ZIP knows
  bool good = true;
  for (const ZipEntry& entry : entries) {
    zip_source_t* source = zip_source_buffer(archive, entry.bytes.data(), entry.bytes.size(), 0);
    const zip_int64_t index = source ? zip_file_add(archive, entry.name.c_str(), source, 0) : -1;
    good = good && index >= 0;
    if (!good) break;
    const auto at = static_cast<zip_uint64_t>(index);
    good = zip_set_file_compression(archive, at, ZIP_CM_STORE, 0) == 0 &&
           zip_file_set_dostime(archive, at, 0, kFirstDay, 0) == 0;
  }
  if (!good || zip_close(archive) != 0) {
    const std::unique_ptr<zip_t, void (*)(zip_t*)> discarded(archive, zip_discard);
    refuse_without_memory(zip_get_error(archive));
    const std::string words = zip_strerror(archive);
    throw Error("zip", "the archive could not be put together: " + words);
  }
  zip_stat_t about;
  zip_source_stat(target, &about);
  std::vector<std::byte> bytes(about.size);
  if (zip_source_open(target) != 0 ||
      zip_source_read(target, bytes.data(), bytes.size()) != static_cast<zip_int64_t>(bytes.size()))
    throw Error("zip", "the archive could not be read back");
  zip_source_close(target);
  return bytes;
}

}  // namespace splatcut
