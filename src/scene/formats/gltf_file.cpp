#include "scene/formats/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/base64.h"
#include "core/error.h"
#include "core/json_file.h"
#include "scene/cloud/quantise.h"
#include "scene/formats/decode.h"
#include "scene/formats/glb.h"
#include "scene/packing/incomplete.h"

namespace splatcut {

namespace {

using nlohmann::json;
using namespace gltf;

std::span<const std::byte> chunk_at(const MappedFile& file, std::size_t* at, std::uint32_t* type) {
  const std::span<const std::byte> all = file.bytes();
  if (all.size() - *at < sizeof(ChunkHeader)) return {};
  const auto header = load<ChunkHeader>(all.data() + *at);
  *at += sizeof header;
  if (header.bytes > all.size() - *at)
    throw Error(file.path().string(), incomplete(fmt::format("a part of {} bytes begins at byte {} of {}",
                                                             header.bytes, *at, all.size())));
  const auto chunk = all.subspan(*at, header.bytes);
  *at += header.bytes;
  *type = header.type;
  return chunk;
}

std::string_view text_of(std::span<const std::byte> chunk) {
  return {reinterpret_cast<const char*>(chunk.data()), chunk.size()};
}

int hex_digit(char c) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const std::size_t at = kDigits.find(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  return at == kDigits.npos ? -1 : static_cast<int>(at);
}

// %20 is a blank, and so on.
std::string without_percent_signs(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(uri[i + 2]) : -1;
    text += low >= 0 ? static_cast<char>(high << 4 | low) : uri[i];
    if (low >= 0) i += 2;
  }
  return text;
}

void open_buffers(const MappedFile& file, std::span<const std::byte> binary, Gltf* gltf) {
  for (const json& buffer : gltf->text.value("buffers", json::array())) {
    if (!buffer.contains("uri")) {
      gltf->buffers.push_back(binary);
      continue;
    }
    const auto& said = buffer.at("uri").get_ref<const std::string&>();
    if (constexpr std::string_view kInText = "data:"; said.starts_with(kInText)) {
      constexpr std::string_view kBase64 = ";base64,";
      const std::size_t begin = said.find(kBase64);
      auto bytes = begin == said.npos || said.find(',') < begin
                       ? std::nullopt
                       : bytes_of_base64(std::string_view(said).substr(begin + kBase64.size()));
      if (!bytes) throw Error(file.path().string(), "a buffer inside the text is not written as base64");
      gltf->inside.push_back(*std::move(bytes));
      gltf->buffers.emplace_back(gltf->inside.back());
      continue;
    }
    const auto uri = std::filesystem::path(without_percent_signs(said)).lexically_normal();
    if (uri.empty() || uri.is_absolute() || *uri.begin() == ".." ||
        uri.string().find(':') != std::string::npos)
      throw Error(file.path().string(), "its numbers are in another folder, not beside it or below",
                  "Save it as .glb, which holds all in one file");
    gltf->beside.push_back(std::make_unique<MappedFile>(file.path().parent_path() / uri));
    gltf->buffers.push_back(gltf->beside.back()->bytes());
  }
}

// Numbers that are quantised are read as they are; packed ones would be read as noise.
void check_required(const MappedFile& file, const json& text) {
  const auto refuse = [&](const std::string& name) {
    throw Error(file.path().string(), fmt::format("needs the extension {}, which is not read", name),
                "Export it without, or as .ply or .spz");
  };
  for (const json& name : text.value("extensionsRequired", json::array()))
    if (name != kExtension && name != "KHR_mesh_quantization") refuse(name.get<std::string>());
  for (const json& view : text.value("bufferViews", json::array())) {
    const json extensions = view.value("extensions", json::object());  // named: items() only refers to it
    for (const auto& [name, extension] : extensions.items())
      if (name.find("meshopt") != name.npos) refuse(name);
  }
}

}  // namespace

Gltf::Gltf(const MappedFile& file) {
  std::span<const std::byte> binary;
  if (begins_with(file, kGlbMark)) {
    std::size_t at = sizeof(GlbHeader);
    std::uint32_t type = 0;
    if (file.bytes().size() < at) throw Error(file.path().string(), incomplete("the header is cut"));
    const auto version = load<GlbHeader>(file.bytes().data()).version;
    if (version != 2)
      throw Error(file.path().string(), fmt::format("version {} of .glb is not supported", version));
    const auto chunk = chunk_at(file, &at, &type);
    if (type != kJsonChunk) throw Error(file.path().string(), incomplete("it has no text"));
    text = parse_json(file.path(), text_of(chunk));
    binary = chunk_at(file, &at, &type);
    if (type != kBinaryChunk) binary = {};
  } else {
    text = parse_json(file.path(), file.text());
  }
  check_required(file, text);
  open_buffers(file, binary, this);
}

}  // namespace splatcut
