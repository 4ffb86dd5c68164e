// A document as JSON, for work files: the one at the top of the file, and every step of the history.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "app/document/document.h"

namespace splatcut {

// How arrays over the Gaussians are written and read; `most`: the largest value that one may hold.
using WriteFlags = std::function<nlohmann::json(const Flags&)>;
using ReadFlags = std::function<Flags(const nlohmann::json&, std::uint8_t most)>;

nlohmann::json document_json(const Document& document, const WriteFlags& flags);

// objects: those of the document, wherever they stand. Throws Error, or a json::exception where the form is
// not the expected one.
Document document_from(const nlohmann::json& j, std::span<const nlohmann::json* const> objects,
                       const ReadFlags& flags);

}  // namespace splatcut
