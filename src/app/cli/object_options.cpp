#include "app/cli/object_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <utility>

#include "app/console/mask_folder.h"
#include "app/console/seeds_file.h"
#include "core/error.h"
#include "core/json_file.h"

namespace splatcut {

namespace {

// The file is read once: it may be a pipe. The text itself may stand in its place.
void read_seeds(const std::filesystem::path& file, ObjectInput* input) {
  const bool is_text = file.native().starts_with('{');
  const std::string where = is_text ? "seeds" : file.string();
  const nlohmann::json seeds = is_text ? parse_json(where, file.native()) : json_of_file(file);
  refuse_unknown_seeds(seeds, where);
  input->objects = named_seeds_from_json(seeds, where);
  input->strokes = strokes_from_json(seeds, where);
  if (!input->objects.empty() && !input->strokes.empty())
    throw Error(where, "holds clicks, boxes or scribbles beside \"objects\"",
                "Put them into one of the objects");
  if (!input->objects.empty()) return;
  if (input->strokes.empty()) throw Error(where, "holds neither clicks nor boxes nor scribbles");
  input->choice = choice_from_json(seeds, where);
  input->camera = camera_from_json(seeds, where);
}

// A pixel that is said to be both; empty for none.
std::string contradiction(const Strokes& strokes) {
  for (std::size_t i = 0; i < strokes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Stroke &a = strokes[i], &b = strokes[j];
      if (a.label == b.label || !a.is_click() || !b.is_click()) continue;
      if (glm::floor(a.points_px[0]) != glm::floor(b.points_px[0])) continue;
      return fmt::format("the pixel {:.0f},{:.0f} is said to be both object and rest",
                         std::floor(a.points_px[0].x), std::floor(a.points_px[0].y));
    }
  return {};
}

// Where nobody says the view of a mask, another size is all that tells that it is not the guessed one's.
std::string doubt_of_view(const Mask& mask, const std::filesystem::path& path, const CameraOptions& camera,
                          const ChosenCamera& chosen) {
  const Camera& view = chosen.camera;
  const bool guessed = chosen.given.empty() && camera.position.empty();
  if (!guessed || (mask.width() == view.width_px && mask.height() == view.height_px)) return {};
  return fmt::format(
      "{} has {} x {} pixels, the view {} x {}: it may be of another view. Give the mask's own with "
      "--cameras and --camera",
      path.filename().string(), mask.width(), mask.height(), view.width_px, view.height_px);
}

}  // namespace

void ObjectOptions::add_to(CLI::App& command) {
  // A scene may stand behind one: it is no further click.
  CLI::Option* by_clicks =
      command
          .add_option("--click", clicks, "Pixel x,y[:object|:rest] of the reference view; may be repeated")
          ->allow_extra_args(false);
  CLI::Option* by_boxes =
      command
          .add_option("--box", boxes,
                      "Box x0,y0,x1,y1[:object|:rest] around what is meant, in pixels of the reference view; "
                      "may be repeated; clicks correct it")
          ->allow_extra_args(false);
  CLI::Option* by_seeds =
      command.add_option("--seeds", seeds,
                         "JSON file (or its text) with clicks, boxes and scribbles, or with several "
                         "objects of them: what two claim is the later one's");
  CLI::Option* by_mask = command.add_option(
      "--mask", mask, "Mask of the reference view: white, alpha, any colour on black, ids (PNG, JPEG, WebP)");
  CLI::Option* by_masks = command.add_option(
      "--masks", masks_folder, "Folder with a mask per camera of --cameras, NAME.png or NAME.jpg.png");
  CLI::Option* by_words = command.add_option_function<std::string>(
      "--text",
      [this](const std::string& words) {
        text = words;
        by_text = true;
      },
      "What is meant in words, for the program of --segmenter");
  command
      .add_option("--segmenter", segmenter,
                  "Program that writes a mask: 'PROGRAM {image} {text} {mask}' (or the environment's "
                  "SPLATCUT_SEGMENTER)")
      ->needs(by_words);
  for (CLI::Option* alone : {by_mask, by_masks, by_words})
    for (CLI::Option* other : {by_clicks, by_boxes, by_seeds, by_mask, by_masks, by_words})
      if (alone != other) alone->excludes(other);
}

ObjectInput ObjectOptions::read(const CameraOptions& camera) const {
  ObjectInput input;
  input.mask = mask;
  input.masks_folder = masks_folder;
  if (by_text) input.segmenter = make_segmenter({text, segmenter});
  if (!seeds.empty()) read_seeds(seeds, &input);
  for (const std::string& corners : boxes) input.strokes.push_back(parse_box(corners));
  for (const std::string& pixel : clicks) input.strokes.push_back(parse_click(pixel));
  if (!input.objects.empty() && !input.strokes.empty())
    throw Error(clicks.empty() ? "--box" : "--click", "belongs to no object, as --seeds holds several",
                "Add it to one of them in the file");
  if (input.camera && !(camera.position + camera.target).empty())
    throw Error("--seeds", "names a camera, and --camera-pos another view", "Leave one of them out");
  if (input.camera && clicks.size() + boxes.size() > 0)
    throw Error(clicks.empty() ? "--box" : "--click",
                "belongs to the view of --camera, and --seeds names another", "Add it to the file");
  if (!masks_folder.empty() && camera.cameras.empty())
    throw Error("--masks", "needs the cameras of the masks", "Give them with --cameras");
  if (!masks_folder.empty() && !(camera.position + camera.target).empty())
    throw Error("--masks", "belongs to the cameras of --cameras, not to --camera-pos",
                "Choose the reference with --camera");
  const bool masked = !mask.empty() || !masks_folder.empty() || by_text;
  if (input.strokes.empty() && input.objects.empty() && !masked)
    throw Error(
        "splatcut cut", "nothing says which object is meant",
        "Give --click x,y, --box x0,y0,x1,y1, --seeds FILE, --mask FILE, --masks FOLDER or --text WORDS");
  return input;
}

CutRequest request_of(const ObjectInput& input, const CameraOptions& camera, const GaussianCloud& cloud,
                      const Job& job, ChosenCamera* chosen, RequestRemarks* remarks) {
  CutRequest request;
  request.choice = input.choice;
  if (input.camera) chosen->camera = camera_of_seeds(*input.camera, "--seeds", *chosen, camera);
  if (!input.strokes.empty()) request.strokes = {{chosen->camera, input.strokes}};
  if (std::string both = contradiction(input.strokes); !both.empty())
    remarks->warnings.push_back(std::move(both));
  if (!input.mask.empty() && chosen->given.size() > 1 && (camera.camera + camera.position).empty())
    remarks->warnings.push_back(
        fmt::format("{}: taken as a mask of the camera {}, the first of {}. --camera names another",
                    input.mask.string(), chosen->camera.name, chosen->given.size()));
  if (!input.mask.empty()) {
    ReadMask read = read_mask(input.mask);
    remarks->doubt = doubt_of_view(read.mask, input.mask, camera, *chosen);
    request.first_mask = {chosen->camera, checked_mask(std::move(read), chosen->camera, input.mask.string())};
  }
  if (input.segmenter)
    request.first_mask = {chosen->camera, mask_from_text(*input.segmenter, cloud, chosen->camera, job)};
  if (input.masks_folder.empty()) return request;
  MaskFolderOptions wanted{input.masks_folder, {}, {}};
  if (!camera.camera.empty()) wanted.reference = chosen->camera.name;
  if (!camera.size.empty()) wanted.size_px = {chosen->camera.width_px, chosen->camera.height_px};
  MaskFolder found = load_mask_folder(chosen->given, wanted);
  chosen->camera = found.reference.camera;
  request.first_mask = std::move(found.reference);
  request.masks = std::move(found.others);
  remarks->understood = found.how;
  remarks->warnings.insert(remarks->warnings.end(), found.warnings.begin(), found.warnings.end());
  return request;
}

}  // namespace splatcut
