// ZIP archives in memory. Internal to src/scene.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/mapped_file.h"

struct zip;

namespace splatcut {

class ZipReader {
 public:
  explicit ZipReader(const MappedFile& file);  // throws Error for what is no ZIP

  // The path in the archive of the first file of that name, in whatever folder; empty where there is none.
  std::string find(const std::string& name) const;
  // Throws Error for a file that is missing, damaged, encrypted, or beyond check_expansion().
  std::vector<std::byte> read(const std::string& path) const;

 private:
  const MappedFile& file_;
  std::unique_ptr<zip, void (*)(zip*)> archive_;
};

struct ZipEntry {
  std::string name;
  std::vector<std::byte> bytes;
};
// Stored as they are, without times, so that the same entries give the same bytes.
std::vector<std::byte> zip_of(std::span<const ZipEntry> entries);

}  // namespace splatcut
