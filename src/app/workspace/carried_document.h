// Carries a document over to its scene after files of the scene were added, taken out or moved.
//
// Labels, hand marks and deletions follow their Gaussians; Gaussians of added files have none. Labels that
// are current stay current, see ObjectItem::cut_kept. Strokes do not see Gaussians of files that were added
// or moved, and the next cut knows none of these either, so that they mean what they meant. If more than half
// of an object lies in one file that has moved, the object's views move with that file and see that file
// alone. Of an object whose first cut is on its way counts what its first stroke is made on.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/document/document.h"
#include "app/document/opened_scene.h"
#include "app/document/stroke_hits.h"

namespace splatcut {

class CarriedDocument {
 public:
  // Files of both scenes are matched by their ids. The constructor copies what it needs: neither scene has to
  // outlive this object.
  CarriedDocument(const OpenedScene& before, const OpenedScene& after);

  // Returns the carried document. Documents that share an array share the carried array, too: calls for all
  // states of a history cost memory for distinct arrays only.
  Document operator()(const Document& document);
  Flags carried(const Flags& flags);  // one per Gaussian; null stays null

 private:
  struct File {  // a file of the new scene
    bool moved = false;
    Similarity to;  // movement from the old place to the new one
  };
  static constexpr std::int32_t kNew = -1, kAnyFile = -1;
  Flags seen(const Flags& flags, std::int32_t only_file);
  const Flags& hit_by_first_stroke(const ObjectItem& object);
  std::int32_t followed_file(const ObjectItem& object);
  void carry_views(ObjectItem* object);

  std::vector<File> files_;
  std::size_t gaussians_before_;
  DrawnPart drawn_before_;
  // Index in the old scene, or kNew, and index of the file in files_, for each Gaussian of the new scene.
  std::vector<std::int32_t> before_of_, file_of_;
  std::map<std::pair<Flags, std::int32_t>, Flags> known_;
  std::map<Flags, std::int32_t> followed_;  // by what an object has
  std::map<std::string, Flags> hit_;        // by key_of_first_stroke()
};

}  // namespace splatcut
