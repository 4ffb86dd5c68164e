// Final labels of the document's objects, made once and kept until something that they come from changes.
//
// Not thread-safe: each thread that needs one has its own.
#pragma once

#include <map>

#include "app/document/document.h"

namespace splatcut {

class LabelCache {
 public:
  // As labels_of() has them; never null.
  const Flags& labels(const Document& document, const ObjectItem& object, std::size_t gaussians);
  std::size_t count(const Document& document, const ObjectItem& object, std::size_t gaussians);
  void clear() { kept_.clear(); }

 private:
  struct Kept {
    Flags cut, hand, deleted, whole;  // that the labels were made from
    Flags labels;
    std::size_t count = 0;
  };
  const Kept& kept(const Document& document, const ObjectItem& object, std::size_t gaussians);

  std::map<ObjectId, Kept> kept_;
};

}  // namespace splatcut
