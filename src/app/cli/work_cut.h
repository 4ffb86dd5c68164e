// `splatcut cut --work F`: computes saved work again, without a window.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "app/cli/cutout_files.h"
#include "app/document/document.h"
#include "app/document/opened_scene.h"

namespace splatcut {

// Every object's labels from its strokes, but for those that are kept (ObjectItem::cut_kept); the result's
// labels are the window's, bit for bit. Throws Error where an object's strokes find nothing. Cancelled: the
// document is incomplete.
Document computed_again(const OpenedScene& scene, Document document, const Job& job = {},
                        const PreparedCache& cache = {});

struct WorkCutOptions {
  std::filesystem::path work, output;
  CutoutOptions cutout;
  bool overwrite = false, json = false, quiet = false;
  PreparedCache cache;
};
// A folder with NAME.ply, NAME.labels.u8 (file order, 1 = object) and NAME.hull.obj for each object, as far
// as the options want them, and report.json.
void run_work_cut(const WorkCutOptions& options);

// Throws Error for what --write may name and saved work is not written as.
void refuse_unwritten(std::span<const std::string> written);

}  // namespace splatcut
