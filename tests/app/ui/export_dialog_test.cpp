// The export dialog: what is typed at once is the name, in a folder that can be written.
#include <doctest/doctest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "hands.h"

using namespace splatcut;
using namespace splatcut::testing;

namespace {

std::filesystem::path proposed(Hands& hands) {
  hands.app.key('E', {false, true, false});
  hands.app.frames(3);
  return hands.app.interface_state().exporting.path;
}

void type(Hands& hands, const std::string& text) {
  for (const char c : text) {
    hands.app->handle(TextTyped{static_cast<unsigned>(c)});
    hands.app.frames(1);
  }
}

// HOME, and whose rights files are opened with: for root every folder can be written.
class AsSomebody {
 public:
  explicit AsSomebody(const std::filesystem::path& home)
      : home_(std::getenv("HOME") ? std::getenv("HOME") : "") {
    constexpr uid_t kNobody = 65534;
    ::setenv("HOME", home.c_str(), 1);
    if (user_ == 0) REQUIRE(::seteuid(kNobody) == 0);
  }
  AsSomebody(const AsSomebody&) = delete;
  AsSomebody& operator=(const AsSomebody&) = delete;
  ~AsSomebody() {
    if (user_ == 0) CHECK(::seteuid(0) == 0);
    ::setenv("HOME", home_.c_str(), 1);
  }

 private:
  uid_t user_ = ::geteuid();
  std::string home_;
};

}  // namespace

TEST_CASE("export dialog: what is typed when it opens replaces the name, not folder and ending") {
  Hands hands;
  const std::filesystem::path before = proposed(hands);
  type(hands, "pear");
  const ExportChoice& choice = hands.app.interface_state().exporting;
  CHECK(choice.path == before.parent_path() / "pear.ply");
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  CHECK_FALSE(hands.app->interface().dialog_open());
  CHECK(proposed(hands) == before);  // a name of its own each time
  type(hands, "plum");
  CHECK(choice.path == before.parent_path() / "plum.ply");
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  REQUIRE(proposed(hands) == before);
  type(hands, "/a/whole.ply");  // replaces folder and ending, too
  CHECK(choice.path == "/a/whole.ply");
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  REQUIRE(proposed(hands) == before);
  type(hands, "pear.spz");  // an ending takes the place of that which is there
  CHECK(choice.path == before.parent_path() / "pear.spz");
  CHECK(choice.format == SceneFormat::kSpz);
  // Another path with a slash where the name began is left as it is.
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  REQUIRE(proposed(hands) == before);
  hands.app.key('A', {.ctrl = true});
  const std::string other = "/" + std::string(before.parent_path().string().size() - 1, 'x') + "/out.ply";
  type(hands, other);
  CHECK(choice.path == other);
}

TEST_CASE("export dialog: a scene in a folder that cannot be written is exported to Documents, or home") {
  const ScratchFolder folder("read_only");
  namespace fs = std::filesystem;
  for (const char* name : {"scene", "home", "home/Documents"}) fs::create_directories(folder / name);
  for (const char* name : {"home", "home/Documents"}) fs::permissions(folder / name, fs::perms::all);
  fs::permissions(folder / "scene", fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                                        fs::perms::others_exec);
  ExportChoice choice;
  const auto goes_to = [&] {
    const AsSomebody somebody(folder / "home");
    return fs::path(proposed_path(choice, folder / "scene/room.ply", nullptr));
  };
  CHECK(goes_to() == folder / "home/Documents/room_object.ply");
  fs::remove(folder / "home/Documents");
  CHECK(goes_to() == folder / "home/room_object.ply");
  fs::permissions(folder / "home", fs::perms::owner_read | fs::perms::owner_exec);
  CHECK(goes_to() == folder / "scene/room_object.ply");  // the dialog says that it cannot be written
  fs::permissions(folder / "scene", fs::perms::all);
  CHECK(goes_to() == folder / "scene/room_object.ply");
  fs::permissions(folder / "home", fs::perms::all);
}

TEST_CASE("export dialog: the next export of a scene is proposed to go where the last one went") {
  const ScratchFolder folder("next_export");
  Hands hands;
  hands.studio().apply(Export{{ExportWhat::kObject, SceneFormat::kPly, folder / "pear.ply"}});
  REQUIRE(hands.app.settle());
  CHECK(proposed(hands).parent_path() == folder.path());
  hands.app.key(key::kEscape);
  hands.app.frames(2);
  hands.studio().apply(Export{{ExportWhat::kAllObjects, SceneFormat::kPly, folder / "both/all"}});
  REQUIRE(hands.app.settle());
  CHECK(proposed(hands).parent_path() == folder / "both");
}
