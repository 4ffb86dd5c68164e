// A document of a scene becomes one of the same scene with other files in it, or files placed otherwise.
//
// Labels, marks and what was deleted go with their Gaussians; Gaussians of added files have none. Labels that
// are current stay so, see ObjectItem::cut_kept. Strokes see what they saw: added files are not in their
// views, files that have moved no longer are. Where most of an object lies in a file that has moved, its
// views move along and see that file alone.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "app/document/document.h"
#include "app/document/opened_scene.h"

namespace splatcut {

class CarriedDocument {
 public:
  // Files are known by their ids. Of both scenes only rows, places and counts are kept.
  CarriedDocument(const OpenedScene& before, const OpenedScene& after);

  // Arrays that documents share are shared by what they become, too.
  Document operator()(const Document& document);

 private:
  struct File {  // of the scene after
    bool moved = false;
    Similarity to;  // from where it stood
  };
  static constexpr std::int32_t kNew = -1, kAnyFile = -1;
  Flags carried(const Flags& flags);
  Flags seen(const Flags& flags, std::int32_t only_file);
  std::int32_t followed_file(const ObjectItem& object) const;
  void carry_views(ObjectItem* object);

  std::vector<File> files_;
  std::vector<std::int32_t> before_of_, file_of_;  // of each Gaussian after: which it was, or kNew; its file
  std::map<std::pair<Flags, std::int32_t>, Flags> known_;
};

}  // namespace splatcut
