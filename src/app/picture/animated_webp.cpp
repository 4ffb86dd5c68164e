#include "app/picture/animated_webp.h"

#include <webp/encode.h>

#include <cassert>
#include <cstdint>
#include <new>
#include <string_view>

#include "core/error.h"

namespace splatcut {

namespace {

using Bytes = std::vector<std::byte>;

void append_number(Bytes* out, std::size_t value, int bytes) {  // little end first
  for (int i = 0; i < bytes; ++i) out->push_back(static_cast<std::byte>(value >> (8 * i)));
}

void append_name(Bytes* out, std::string_view name) {
  for (const char c : name) out->push_back(static_cast<std::byte>(c));
}

void append_chunk(Bytes* out, std::string_view name, std::span<const std::byte> content) {
  append_name(out, name);
  append_number(out, content.size(), 4);
  out->insert(out->end(), content.begin(), content.end());
  if (content.size() % 2 != 0) out->push_back(std::byte{0});
}

std::size_t number_at(std::span<const std::byte> bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::size_t>(bytes[at + i]) << (8 * i);
  return value;
}

// A file of one picture.
Bytes still(const Image<Rgba8>& picture) {
  constexpr float kQuality = 85;
  std::uint8_t* data = nullptr;
  const std::size_t size = WebPEncodeRGBA(picture.pixels().data()->data(), picture.width(), picture.height(),
                                          picture.width() * static_cast<int>(sizeof(Rgba8)), kQuality, &data);
  if (size == 0) throw Error("webp", "a picture could not be packed", "Take a smaller size");
  const auto* first = reinterpret_cast<const std::byte*>(data);
  Bytes out(first, first + size);
  WebPFree(data);
  return out;
}

// What a frame takes over of it: alpha and colours.
Bytes picture_chunks(std::span<const std::byte> file) {
  constexpr std::size_t kRiffHeader = 12, kChunkHeader = 8;
  Bytes out;
  for (std::size_t at = kRiffHeader; at + kChunkHeader <= file.size();) {
    const std::string_view name(reinterpret_cast<const char*>(file.data() + at), 4);
    const std::size_t size = number_at(file, at + 4), whole = kChunkHeader + size + size % 2;
    if (name == "ALPH" || name == "VP8 " || name == "VP8L") {
      const auto chunk = file.subspan(at, std::min(whole, file.size() - at));
      out.insert(out.end(), chunk.begin(), chunk.end());
    }
    at += whole;
  }
  return out;
}

}  // namespace

void AnimatedWebp::add(const Image<Rgba8>& picture) {
  assert(width_px_ == 0 || (picture.width() == width_px_ && picture.height() == height_px_));
  width_px_ = picture.width();
  height_px_ = picture.height();
  constexpr std::size_t kReplaces = 2;  // does not blend with the frame before
  Bytes frame;
  append_number(&frame, 0, 3);  // from the left, from the top
  append_number(&frame, 0, 3);
  append_number(&frame, static_cast<std::size_t>(width_px_ - 1), 3);
  append_number(&frame, static_cast<std::size_t>(height_px_ - 1), 3);
  append_number(&frame, static_cast<std::size_t>(frame_ms_), 3);
  append_number(&frame, kReplaces, 1);
  const Bytes chunks = picture_chunks(still(picture));
  frame.insert(frame.end(), chunks.begin(), chunks.end());
  constexpr std::size_t kHeaders = 64;  // of the file, its chunks and this frame's
  if (frames_.size() + frame.size() + kHeaders > most_bytes_)
    throw Error("webp", "the animation is larger than a file of this kind can be",
                "Take fewer or smaller pictures");
  append_chunk(&frames_, "ANMF", frame);
}

std::vector<std::byte> AnimatedWebp::bytes() const {
  assert(!frames_.empty());
  constexpr std::size_t kAlphaAndAnimation = 0x12;
  Bytes size, loop, content;
  append_number(&size, kAlphaAndAnimation, 4);
  append_number(&size, static_cast<std::size_t>(width_px_ - 1), 3);
  append_number(&size, static_cast<std::size_t>(height_px_ - 1), 3);
  append_number(&loop, 0, 4);  // behind it: nothing
  append_number(&loop, 0, 2);  // for ever
  append_name(&content, "WEBP");
  append_chunk(&content, "VP8X", size);
  append_chunk(&content, "ANIM", loop);
  content.insert(content.end(), frames_.begin(), frames_.end());
  Bytes file;
  append_chunk(&file, "RIFF", content);
  return file;
}

}  // namespace splatcut
