// With which code the program ends: 0 done, 1 what it could not do, 2 wrong usage; and the sentence beside
// it.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "program_runner.h"
#include "small_still_life.h"

using namespace splatcut::testing;

TEST_CASE("a value that its option does not take ends every command with 1, and is named") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  const std::string render = "render " + life.scene + " -o value.png ", cut = life.cut("-o value "),
                    click = cut + "--click 1,1 ";
  const std::pair<std::string, const char*> values[] = {{render, "--size foo"},
                                                        {render, "--camera-fov 999"},
                                                        {render, "--camera-up 0,0,0"},
                                                        {render, "--what foo"},
                                                        {render, "--background red"},
                                                        {render, "--lowpass -1"},
                                                        {render, "--lowpass x"},
                                                        {cut, "--click 1"},
                                                        {cut, "--box 1,2,3"},
                                                        {click, "--views -1"},
                                                        {click, "--views 401"},
                                                        {click, "--scale -101"},
                                                        {click, "--choice 4"},
                                                        {click, "--smoothness foo"},
                                                        {click, "--write foo"},
                                                        {click, "--edges foo"},
                                                        {click, "--fill foo"},
                                                        {click, "--origin foo"},
                                                        {click, "--preset foo"},
                                                        {click, "--first-mask foo"},
                                                        {click, "--scale-by 1,1"},
                                                        {"info a.ply ", "--lod x"},
                                                        {"info a.ply ", "--threads -1"},
                                                        {"batch a.jsonl -o b ", "--shard 3/2"},
                                                        {"batch a.jsonl -o b ", "--jobs 0"},
                                                        {"compare a.png a.png ", "--max-diff 300"}};
  for (const auto& [command, option] : values) {
    const Result refused = place.run(command + option);
    CHECK_MESSAGE(refused.code == 1, (command + option));
    const std::string name(std::string_view(option).substr(2, std::string_view(option).find(' ') - 2));
    CHECK_MESSAGE(refused.err.find(name) != std::string::npos, refused.err);
  }
  CHECK_FALSE(place.exists("value"));
  CHECK_FALSE(place.exists("value.png"));
}

TEST_CASE("view --spz-axes: scenes of which none is a .spz are refused before a window opens") {
  Workplace& place = still_life().place;
  if (place.run("view --help").out.find("--spz-axes") == std::string::npos) return;  // built without a window
  for (const char* scenes : {"axes.ply", "axes.ply axes.splat", "axes.splatcut.json"}) {
    place.write("axes.ply", "ply\n");
    place.write("axes.splat", "");
    place.write("axes.splatcut.json", "{}");
    const Result refused = place.run(std::string("view ") + scenes + " --spz-axes ply");
    CHECK(refused.code == 1);
    CHECK_MESSAGE(refused.err.find("is no .spz") != std::string::npos, refused.err);
  }
}

TEST_CASE("view --cameras: a file that is not there, and saved work, are refused before a window opens") {
  Workplace& place = still_life().place;
  if (place.run("view --help").out.find("--cameras") == std::string::npos) return;  // built without a window
  place.write("seen.ply", "ply\n");
  place.write("seen.splatcut.json", "{}");
  for (const auto& [options, said] :
       {std::pair("seen.ply --cameras none.json", "none.json: there is no such file"),
        std::pair("seen.splatcut.json --cameras seen.ply", "has its own cameras")}) {
    const Result refused = place.run(std::string("view ") + options);
    CHECK(refused.code == 1);
    CHECK_MESSAGE(refused.err.find(said) != std::string::npos, refused.err);
  }
  CHECK(place.run("view --cameras seen.ply").code == 2);
}

TEST_CASE("wrong usage exits with 2, a thing that cannot be done with 1 and a sentence on stderr") {
  StillLife& life = still_life();
  Workplace& place = life.place;
  CHECK(place.run("--version").code == 0);
  CHECK(place.run("cut --help").code == 0);
  for (const char* usage :
       {"fly", "cut", "info", "render a.ply", "cut a.ply -o b --no-such-option", "info a.ply --threads",
        "cut a.ply -o b --mask a.png --scale 1", "cut a.ply -o b --seeds a.json --choice 2",
        "cut a.ply -o b --mask a.png --first-mask parts", "cut a.ply -o b --click 1,1 --parts-only --views 3",
        "cut a.ply -o b --click 1,1 --parts-only --smoothness 2",
        "cut a.ply -o b --click 1,1 --parts-only --coarse"})
    CHECK_MESSAGE(place.run(usage).code == 2, usage);
  const Result unknown = place.run("mege a.ply b.ply");
  CHECK(unknown.code == 2);
  CHECK_MESSAGE(unknown.err.find("mege is neither a command nor a file that is there") != std::string::npos,
                unknown.err);
  CHECK(unknown.err.find("merge") != std::string::npos);
  for (const char* unseen : {"--labels made/small.labels.u8", "--what depth --background 1,1,1"})
    CHECK_MESSAGE(place.run("render " + life.scene + " -o a.png " + unseen).code == 2, unseen);
  // NaN is no number, 255 no share of 1; what is out of range is said as it was given.
  const std::string view = "render " + life.scene + " --size 8x8 -o a.png ";
  for (const char* option : {"--camera-fov nan", "--lowpass nan", "--lowpass inf", "--background 255,255,255",
                             "--background -1,0,0"})
    CHECK_MESSAGE(place.run(view + option).code == 1, option);
  for (const char* option : {"--psnr nan", "--pixels nan", "--ssim nan"})
    CHECK_MESSAGE(place.run(std::string("compare a.png a.png ") + option).code == 1, option);
  const Result threads = place.run("info " + life.scene + " --threads -1");
  CHECK(threads.code == 1);
  CHECK_MESSAGE(threads.err.find("--threads: Value -1 not in range") != std::string::npos, threads.err);
  CHECK(threads.err.find("e+") == std::string::npos);
  place.write("points.ply",
              "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float "
              "y\nproperty float z\nend_header\n" +
                  std::string(12, 'a'));
  place.write("short.ply", place.text("made/small.ply").substr(0, 100000));
  place.write("bad.json", "{");
  place.write("empty.ply", "");
  place.make_folder("pair");
  place.write("pair/a.ply", "a");
  place.write("pair/b.ply", "b");
  const auto refused = [&](const std::string& arguments, std::initializer_list<const char*> parts) {
    const Result result = place.run(arguments);
    CAPTURE(arguments);
    CAPTURE(result.err);
    CHECK(result.code == 1);
    CHECK((result.err.starts_with("splatcut: ") || result.err.starts_with("splatcut-lab: ")));
    CHECK(result.err.ends_with(".\n"));
    for (const char* part : parts) CHECK(result.err.find(part) != std::string::npos);
  };
  refused("info none.ply", {"none.ply", "No such file"});
  const Result folder = place.run("info made");
  CHECK_MESSAGE(folder.code == 0, folder.err);
  CHECK_MESSAGE(folder.err.find("small.ply is read, the only scene in the folder") != std::string::npos,
                folder.err);
  refused("info pair", {"pair", "this folder is no scene by itself", "a.ply, b.ply"});
  refused("info empty.ply", {"empty.ply", "empty"});
  refused("info points.ply", {"points.ply", "ordinary point cloud"});
  refused("info short.ply", {"short.ply", "truncated", "row", "byte"});
  refused("convert " + life.scene + " -o a.obj", {"a.obj", "extension"});
  refused("render " + life.scene + " -o a.png --size 0x7", {"--size 0x7"});
  refused("render " + life.scene + " -o a.png --background red", {"is not a colour", "r,g,b"});
  refused("render " + life.scene + " -o a.png --camera-pos 1e38,0,0 --camera-target 0,0,0",
          {"too far apart"});
  refused(life.cut("-o b --mask empty.ply"), {"empty.ply", "the file is empty"});
  refused("render " + life.scene + " -o a.png --size 4294967297x1",
          {"--size 4294967297x1", "from 1 to 16384"});
  refused("render " + life.scene + " -o a.png --size 5", {"--size 5"});
  refused("render " + life.scene + " -o a.png --camera-pos 1,2", {"--camera-pos"});
  refused(view + "--cameras made/cameras.json --camera-fov 40", {"--camera-fov", "has its own"});
  refused(life.cut("--click 1,1 --fill surface --write object -o cut"), {"--fill surface", "rest.ply"});
  refused(life.cut("--click 1,1 --write rest,fill -o cut"), {"--write fill", "Add --fill surface"});
  refused(view + "--cameras made/cameras.json --camera 0 --camera-pos 1,2,3 --camera-target 0,0,0",
          {"--camera and --camera-pos name two views"});
  refused("render " + life.scene + " -o a.png --cameras none.json", {"none.json"});
  refused("render " + life.scene + " -o a.png --cameras bad.json", {"bad.json", "JSON"});
  refused("render " + life.scene + " -o a.png --cameras made/cameras.json --camera 99", {"camera \"99\""});
  refused("render " + life.scene + " -o nowhere/a.png", {"nowhere/a.png"});
  refused(view + "--camera 1", {"--camera 1", "--cameras"});
  refused(life.cut("-o cut"), {"--click"});
  refused(life.cut("-o cut --click 1"), {"--click 1", "x,y"});
  refused(life.cut("-o cut --click 1,2:sky"), {"sky", "object or rest"});
  refused(life.cut("-o cut --click 5000,2"), {"5000", "outside"});
  refused(life.cut("-o cut --seeds bad.json"), {"bad.json", "JSON"});
  for (const char* scale : {"1.5", "true", "4294967297", "1e30", "\"1\""}) {
    life.place.write("scaled.json", fmt::format(R"({{"clicks": [{{"x": 9, "y": 9, "scale": {}}}]}})", scale));
    refused(life.cut("-o cut --seeds scaled.json"), {"scaled.json", "\"scale\" is no whole number"});
  }
  refused(life.cut("-o cut --box 1,1,inf,9"), {"--box 1,1,inf,9", "outside of any picture"});
  refused(life.cut("-o cut --click 1,1 --preset paper --scale 1"),
          {"--scale", "first mask comes from pixels"});
  refused(life.cut("-o cut --click 1,1 --preset paper --choice 2"),
          {"--choice", "first mask comes from pixels"});
  refused(life.cut("-o cut --masks made --set parts_only=1"), {"parts_only", "masks are given"});
  refused(life.cut("-o cut --mask none.png"), {"none.png"});
  const char* const presets = "default, paper or paper-code";
  refused("cut " + life.scene + " -o cut --click 1,1 --preset slow", {"slow", presets});
  refused("eval made/suite.json -o cut --preset slow", {"slow", presets});
  refused(life.cut("-o cut --click 1,1 --refine foo"), {"views.refine", "foo", "none, grabcut or pixelcut"});
  refused(life.cut("-o cut --click 1,1 --first-mask foo"), {"foo", "parts, grabcut, pixelcut"});
  refused(life.cut("-o cut --click 1,1 --smoothness -1"), {"smoothness", "-1", "from 0 to 500"});
  place.write("w.splatcut.json", "{}");
  for (const char* beside : {"made/small.ply", "--click 1,1", "--preset paper", "--set trim=0", "--coarse",
                             "--masks masks", "--camera 0", "--scale 1", "--choice 2", "--smoothness 2"})
    refused(std::string("cut --work w.splatcut.json -o cut ") + beside,
            {"--work", "cannot go with",
             std::string_view(beside).starts_with("--")
                 ? std::string(beside).substr(0, std::string(beside).find(' ')).c_str()
                 : "scene"});
  refused("cut --work w.splatcut.json -o cut --write labels,rest",
          {"--write rest", "object, labels and hull"});
  refused("eval bad.json -o cut", {"bad.json", "JSON"});
  place.write("no_truth.json", R"({"scenes": [{"name": "a", "scene": "made/small.ply"}]})");
  refused("eval no_truth.json -o cut", {"entry a", "reference"});
  refused(life.cut("--click " + life.click + " -o cut --first-mask grabcut --parts-only"),
          {"parts", "pixels"});
  CHECK_FALSE(place.exists("cut"));
  CHECK_FALSE(place.exists("a.png"));
  CHECK(place.leftovers().empty());
}
