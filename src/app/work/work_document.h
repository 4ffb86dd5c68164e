// A document as JSON, for work files: the document at the top of the file, and that of every history step.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "app/document/document.h"

namespace splatcut {

// Functions that write and read arrays over the Gaussians. most: the largest value that an element may have.
using WriteFlags = std::function<nlohmann::json(const Flags&)>;
using ReadFlags = std::function<Flags(const nlohmann::json&, std::uint8_t most)>;

nlohmann::json document_json(const Document& document, const WriteFlags& flags);

// Reads a document. objects: its objects, which need not stand in `j`. unknown_preset: if not null,
// a preset that this program does not know is written there and becomes the default one. Throws Error if a
// value is out of range, and json::exception if the form is not the expected one.
Document document_from(const nlohmann::json& j, std::span<const nlohmann::json* const> objects,
                       const ReadFlags& flags, std::string* unknown_preset = nullptr);

}  // namespace splatcut
