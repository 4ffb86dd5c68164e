// Cache of the final labels of the document's objects. An entry holds until one of its inputs changes.
//
// The cache is not thread-safe: each thread that needs one has its own.
#pragma once

#include <map>

#include "app/document/document.h"

namespace splatcut {

class LabelCache {
 public:
  // Labels as labels_of() gives them; never null.
  const Flags& labels(const Document& document, const ObjectItem& object, std::size_t gaussians);
  std::size_t count(const Document& document, const ObjectItem& object, std::size_t gaussians);
  void clear() { kept_.clear(); }

 private:
  struct Kept {
    Flags cut, hand, of_others, deleted,
        whole;  // inputs of the labels; whole: labels of the object around it
    Flags labels;
    std::size_t count = 0;
  };
  const Kept& kept(const Document& document, const ObjectItem& object, std::size_t gaussians);

  std::map<ObjectId, Kept> kept_;
};

// The same from a cache; null: they are computed.
Flags known_labels(const Document& document, const ObjectItem& object, std::size_t gaussians,
                   LabelCache* known);

}  // namespace splatcut
