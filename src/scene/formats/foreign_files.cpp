#include "scene/formats/foreign_files.h"

#include <string>
#include <string_view>

#include "core/error.h"
#include "core/lower_case.h"
#include "core/stand_in.h"

namespace splatcut {

namespace {

struct Foreign {
  std::string_view ending, mark;  // what the name ends with, what the file begins with; empty: nothing
  const char *what, *remedy;
};

constexpr const char* kPoints = "is a point cloud of a scanner: its points have no size, rotation or opacity";
constexpr const char* kMesh = "is a mesh: it has no Gaussians";
constexpr const char* kTrain =
    "Train Gaussians from the photographs and give the .ply that the trainer writes";
constexpr const char* kExport = "Export .ply or .spz from the program that made it";

constexpr const char* kPicture = "this is a picture, not a scene of Gaussians";
constexpr const char* kGiveScene = "Give the scene itself";

using namespace std::string_view_literals;
constexpr Foreign kForeign[] = {
    {".las", "LASF", kPoints, kTrain},
    {".laz", "", kPoints, kTrain},
    {".e57", "ASTM-E57", kPoints, kTrain},
    {".pcd", "# .PCD", kPoints, kTrain},
    {".xyz", "", kPoints, kTrain},
    {".pts", "", kPoints, kTrain},
    {".obj", "", kMesh, kTrain},
    {".fbx", "Kaydara FBX", kMesh, kTrain},
    {".stl", "", kMesh, kTrain},
    {".usdz", "", "is a USD package, which is not read", kExport},
    {".usdc", "PXR-USDC", "is a USD file, which is not read", kExport},
    {".usda", "#usda", "is a USD file, which is written here, not read", kExport},
    {".splatv", "\x4b\x67\x00\x00"sv, "is a moving scene (.splatv), which is not read",
     "Export one moment of it as .ply"},
    {".radc", "RADC", "is a piece of a scene of Spark", "Give its .rad"},
    {".ckpt", "", "is a checkpoint of a training, not a scene",
     "Run ns-export gaussian-splat and give its .ply"},
    {".pt", "", "is a checkpoint of a training, not a scene",
     "Train with the option that writes a .ply (gsplat: --save_ply)"},
    {".png", "\x89PNG\r\n\x1a\n"sv, kPicture, kGiveScene},
    {".jpg", "\xff\xd8\xff\xe0\x00\x10JFIF"sv, kPicture, kGiveScene},
    {".pdf", "%PDF-1.", "this is a .pdf, not a scene of Gaussians", kGiveScene},
    {".psht", "", "is a project of Postshot, not a scene", "Choose File > Export there, and .ply"},
    {".ssproj", "", "is a project of SuperSplat, not a scene", "Choose File > Export there, and .ply"},
};

}  // namespace

void refuse_foreign(const MappedFile& file) {
  const std::string name = lower_case(file.path().filename().string());
  const std::string_view content = file.text();
  refuse_stand_in(file.path(), content);
  for (const Foreign& foreign : kForeign)
    if (name.ends_with(foreign.ending) || (!foreign.mark.empty() && content.starts_with(foreign.mark)))
      throw Error(file.path().string(), foreign.what, foreign.remedy);
}

}  // namespace splatcut
