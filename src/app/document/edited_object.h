// What edits of a document begin with: the object that a command names. Included by the edits alone.
#pragma once

#include <fmt/format.h>

#include <cassert>

#include "app/document/document_edits.h"
#include "app/document/label_cache.h"
#include "app/document/scene_graph.h"
#include "app/document/words.h"
#include "core/error.h"

namespace splatcut {

inline ObjectItem& required(Document* document, ObjectId id) {
  ObjectItem* object = document->find(id);
  if (!object) throw Error("", "That object is gone");
  return *object;
}

inline ObjectItem& unlocked(Document* document, ObjectId id) {
  ObjectItem& object = required(document, id);
  if (object.locked) throw Error(object.name, "is locked", "Unlock it in the objects panel");
  return object;
}

// The object that strokes and selections go to.
inline ObjectItem& target(Document* document) {
  return document->active_object() ? unlocked(document, document->active) : add_object(document);
}

inline const FlowGraph& required_graph(const EditContext& context) {
  assert(context.graph);
  return context.graph->get(context.job);
}

inline std::vector<std::uint8_t> labels(const Document& document, const ObjectItem& object,
                                        const EditContext& context) {
  return labels_of(document, object, context.cloud.size());
}

inline std::size_t count_of(const Document& document, const ObjectItem& object, const EditContext& context) {
  return context.labels ? context.labels->count(document, object, context.cloud.size())
                        : count_flags(labels(document, object, context));
}

inline std::string counted(const Document& document, const ObjectItem& object, const EditContext& context) {
  return fmt::format("{}: {} of {} Gaussians", object.name, grouped(count_of(document, object, context)),
                     grouped(context.cloud.size()));
}

}  // namespace splatcut
