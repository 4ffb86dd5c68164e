#include "app/cli/serve_conversation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "app/cli/batch_jobs.h"
#include "app/cli/cut_placing.h"
#include "app/console/kept_inputs.h"
#include "app/console/labels_file.h"
#include "app/console/seeds_file.h"
#include "app/console/setting_options.h"
#include "app/console/version.h"
#include "app/document/export_plan.h"
#include "core/base64.h"
#include "core/error.h"
#include "core/json_file.h"
#include "core/png_file.h"
#include "scene/formats/scene_formats.h"
#include "segment/selection/click_selection.h"
#include "segment/session/doubts.h"

namespace splatcut {

namespace {

void refuse_cancelled(const Job& job) {
  if (job.cancelled()) throw Error("request", "was cancelled, nothing was changed");
}

// The options of a kind that a request gives, in place of those said before.
nlohmann::json with_options(nlohmann::json said, const RequestKind& kind, const nlohmann::json& request) {
  for (const std::string& name : kind.cut_options) {
    said.erase(name);
    if (request.contains(name)) said[name] = request.at(name);
  }
  return said;
}

CutArguments arguments_of(const nlohmann::json& said, const std::string& where) {
  CutArguments args;
  read_arguments(said, where, &args);
  return args;
}

const RequestKind& kind_of(Ask ask) {
  return *std::ranges::find(request_kinds(), ask, &RequestKind::ask);
}

ExportPlacement placement_of(const nlohmann::json& request) {
  ExportPlacement placement =
      placement_by_name(request.value("origin", "scene"), request.value("up", "scene"));
  placement.scale = request.value("scale", 1.0f);
  check_factor(placement.scale, "\"scale\"");
  return placement;
}

}  // namespace

Drawer Conversation::Opened::drawer() {
  return {scene.scene().cloud, nullptr, &scene.session(chosen).blocks()};
}

Conversation::Opened& Conversation::opened() {
  if (!opened_) throw Error("request", "no scene is open", "Send open first");
  return *opened_;
}

const CutResult& Conversation::object() const {
  if (!result_) throw Error("request", "there is no object yet", "Send click, scribble or box first");
  return *result_;
}

nlohmann::json Conversation::answer(const nlohmann::json& request, const Job& job) {
  const RequestKind& kind = checked_kind(request);
  switch (kind.ask) {
    case Ask::kOpen:
      return open(request, job);
    case Ask::kCamera:
      return look(kind, request);
    case Ask::kSettings:
      return set(kind, request, job);
    case Ask::kClick:
      return stroke(strokes_from_json({{"clicks", {request}}}, kind.name), job);
    case Ask::kScribble:
      return stroke(strokes_from_json({{"scribbles", {request}}}, kind.name), job);
    case Ask::kBox:
      return stroke(strokes_from_json({{"boxes", {request}}}, kind.name), job);
    case Ask::kSize:
      object();
      if (result_->sizes == 0)
        throw Error("size", "the last stroke has no other sizes", "Only a click has, and the first stroke");
      return step({.size = request.at("step")}, job);
    case Ask::kChoice:
      object();
      return step({.choice = choice_from_json(request, kind.name)}, job);
    case Ask::kUndo:
      return undo(job);
    case Ask::kPreview:
      return preview(request, job);
    case Ask::kLabels:
      return labels(request);
    case Ask::kExport:
      return save(request, job);
    case Ask::kClear:
    case Ask::kClose:
      opened();
      steps_.clear();
      result_.reset();
      if (kind.ask == Ask::kClose) opened_.reset();
      return nlohmann::json::object();
    case Ask::kQuit:
      ended_ = true;
      return nlohmann::json::object();
    case Ask::kCancel:
      return {{"cancelled", false}};  // what waits or runs is cancelled where requests are read
    case Ask::kDescribe:
      break;
  }
  return {{"protocol", kProtocol}, {"version", version()}, {"schema", request_schema()}};
}

nlohmann::json Conversation::open(const nlohmann::json& request, const Job& job) {
  nlohmann::json said = with_options({{"scene", request.at("scene")}}, kind_of(Ask::kOpen), request);
  CutArguments args = arguments_of(said, "open");
  opened_.reset();  // first: two scenes may not find room
  steps_.clear();
  result_.reset();
  SharedScene scene(args, cache_, true, job);
  refuse_cancelled(job);
  ChosenCamera chosen = choose_camera(args.camera, scene.scene());
  const CutSettings settings = args.settings();
  opened_ = std::make_unique<Opened>(
      Opened{std::move(said), std::move(args), std::move(scene), std::move(chosen), settings});
  const Scene& loaded = opened_->scene.scene();
  nlohmann::json reply = camera_json(), remarks = opened_->args.how.remarks(loaded),
                 cameras = nlohmann::json::array();
  if (!opened_->chosen.warning.empty()) remarks.push_back(opened_->chosen.warning);
  for (const Camera& camera : opened_->chosen.given) cameras.push_back(camera.name);
  reply.update({{"gaussians", loaded.cloud.size()},
                {"rows", loaded.file_rows},
                {"cameras", cameras},
                {"remarks", remarks}});
  return reply;
}

nlohmann::json Conversation::camera_json() {
  const Camera& camera = opened().chosen.camera;
  const glm::dvec3 at = glm::dvec3(camera.centre_world()) + opened().scene.scene().origin;
  return {{"camera",
           {{"name", camera.name},
            {"size", {camera.width_px, camera.height_px}},
            {"position", {at.x, at.y, at.z}}}}};
}

nlohmann::json Conversation::look(const RequestKind& kind, const nlohmann::json& request) {
  Opened& open = opened();
  nlohmann::json said = with_options(open.said, kind, request);
  CutArguments args = arguments_of(said, kind.name);
  open.chosen = choose_camera(args.camera, open.scene.scene());
  open.said = std::move(said);
  open.args = std::move(args);
  nlohmann::json reply = camera_json();
  reply["remarks"] =
      open.chosen.warning.empty() ? nlohmann::json::array() : nlohmann::json{open.chosen.warning};
  return reply;
}

nlohmann::json Conversation::set(const RequestKind& kind, const nlohmann::json& request, const Job& job) {
  Opened& open = opened();
  nlohmann::json said = with_options(open.said, kind, request);
  CutArguments args = arguments_of(said, kind.name);
  const CutSettings settings = args.settings();
  if (!steps_.empty()) cut(steps_, settings, job);
  open.said = std::move(said);
  open.args = std::move(args);
  open.settings = settings;
  nlohmann::json reply = result_ ? object_json() : nlohmann::json::object();
  reply["values"] = values_json(settings);
  return reply;
}

// Strokes of one camera that follow each other stand together, as those of `cut` do.
CutRequest Conversation::request_of(const std::vector<Step>& steps) const {
  CutRequest request;
  for (const Step& step : steps) {
    if (step.choice) {
      request.choice = *step.choice;
      first_stroke(&request.strokes)->size_step = 0;
    }
    if (step.size) last_stroke(&request.strokes)->size_step = *step.size;
    if (!step.stroke) continue;
    if (!request.strokes.empty() && same_view(request.strokes.back().camera, step.stroke->camera))
      request.strokes.back().strokes.push_back(step.stroke->strokes.front());
    else
      request.strokes.push_back(*step.stroke);
  }
  return request;
}

// Keeps steps and result if the cut finds something.
void Conversation::cut(std::vector<Step> steps, const CutSettings& settings, const Job& job) {
  const CutRequest request = request_of(steps);
  check_inside(request);
  CutResult result = opened().scene.session(opened().chosen).cut(request, settings, job);
  refuse_cancelled(job);
  if (result.outcome != Outcome::kDone) throw Error("request", "no object was found: " + result.reason);
  steps_ = std::move(steps);
  result_ = std::move(result);
}

nlohmann::json Conversation::stroke(const Strokes& strokes, const Job& job) {
  return step({.stroke = StrokedView{opened().chosen.camera, strokes}}, job);
}

nlohmann::json Conversation::step(Step made, const Job& job) {
  constexpr std::size_t kMostSteps = 1000;
  if (steps_.size() == kMostSteps)
    throw Error("request", fmt::format("an object takes {} steps and no more", kMostSteps),
                "Send clear or undo");
  std::vector<Step> steps = steps_;
  steps.push_back(std::move(made));
  cut(std::move(steps), opened().settings, job);
  return object_json();
}

nlohmann::json Conversation::undo(const Job& job) {
  opened();
  if (steps_.empty()) throw Error("undo", "there is nothing to take back");
  std::vector<Step> steps = steps_;
  steps.pop_back();
  if (steps.empty()) {
    steps_.clear();
    result_.reset();
    return {{"gaussians", 0}};
  }
  cut(std::move(steps), opened().settings, job);
  return object_json();
}

nlohmann::json Conversation::object_json() const {
  const CutResult& result = object();
  nlohmann::json reply = {{"gaussians", std::ranges::count(result.labels, 1)}, {"doubts", doubts(result)}};
  if (const std::string said = fewer_meanings(result, request_of(steps_).choice); !said.empty())
    reply["doubts"].push_back(said);
  if (!result.meanings.empty())
    reply.update({{"choice", result.choice + 1},
                  {"choices", result.meanings.size()},
                  {"certainty", result.certainty}});
  if (result.sizes > 0) reply.update({{"size", result.size + 1}, {"sizes", result.sizes}});
  return reply;
}

void Conversation::check_output(const std::filesystem::path& path, const nlohmann::json& request) {
  check_output_file(path, request.value("overwrite", false),
                    "Send \"overwrite\": true to replace it, or another \"path\"");
  std::vector<std::filesystem::path> inputs = opened().scene.scene().files;
  inputs.push_back(opened().args.camera.cameras);
  refuse_written_inputs(path, inputs);
}

nlohmann::json Conversation::preview(const nlohmann::json& request, const Job& job) {
  Opened& open = opened();
  const std::string what = request.value("what", result_ ? "tint" : "scene");
  Camera camera = open.chosen.camera;
  if (const int width = request.value("width", camera.width_px); width > 0)
    camera = limited_to_width(camera, width);
  else
    throw Error("preview", "\"width\" is not larger than 0");
  const std::filesystem::path path = request.value("path", "");
  if (!path.empty()) {
    refuse_name_of_png(path);
    check_output(path, request);
  }
  const auto reply = [&](const auto& image) {
    refuse_cancelled(job);
    nlohmann::json fields = {{"width", image.width()}, {"height", image.height()}};
    if (path.empty()) {
      fields["png"] = base64_of(png_bytes(image));
    } else {
      write_png(path, image);
      fields["path"] = path.string();
    }
    return fields;
  };
  if (what == "scene") return reply(rgb8_from_linear(open.drawer().draw(camera, {}, job).colour));
  std::vector<std::uint8_t> shown = object().labels;
  if (what == "tint") return reply(tinted_picture(open.drawer(), camera, shown));
  if (what == "rest")
    for (std::uint8_t& flag : shown) flag = !flag;
  return reply(cutout_picture(open.drawer(), camera, shown));
}

nlohmann::json Conversation::labels(const nlohmann::json& request) {
  const Scene& scene = opened().scene.scene();
  const std::vector<std::uint8_t>& labels = object().labels;
  nlohmann::json reply = {{"rows", scene.file_rows}, {"gaussians", std::ranges::count(labels, 1)}};
  const std::filesystem::path path = request.value("path", "");
  if (path.empty()) {
    reply["labels"] = base64_of(labels_in_file_order(scene, labels));
    return reply;
  }
  if (const SceneFormat* format = find_format(path))
    throw Error(path.string(), fmt::format("is the name of a scene ({})", format->extension),
                "export writes those");
  check_output(path, request);
  write_labels(path, scene, labels);
  reply["path"] = path.string();
  return reply;
}

nlohmann::json Conversation::save(const nlohmann::json& request, const Job& job) {
  Opened& open = opened();
  const Scene& scene = open.scene.scene();
  const std::filesystem::path path = request.at("path").get<std::string>();
  const SceneFormat format = output_format_from_name(path);
  check_output(path, request);
  const CutArguments args = arguments_of(with_options(open.said, kind_of(Ask::kExport), request), "export");
  ExportPlacement placement = placement_of(request);
  if (!args.cutout.known_length.empty()) {
    if (request.contains("scale"))
      throw Error("export", "has both \"scale\" and \"scale-by\"", "Leave one out");
    placement.scale = placement_of(args.cutout, open.drawer(), open.chosen.camera, job).scale;
  }
  const bool rest = request.value("what", "object") == "rest";
  if (!rest && args.cutout.fill == "surface")
    throw Error("export", "\"fill\" fills the hole in the rest, and the object is written",
                "Leave it out, or give \"what\": \"rest\"");
  const std::vector<std::uint8_t>& labels = object().labels;
  std::vector<std::uint8_t> keep = labels;
  if (rest)
    for (std::uint8_t& flag : keep) flag = !flag;
  std::optional<CleanObject> clean;
  if (args.cutout.clean())
    clean = clean_object({open.drawer(), labels, open.chosen.up_world, open.chosen.given, rest}, {}, job);
  const bool cleaned = clean && clean->report.cleaned;
  RestChanges changes = cleaned && rest ? clean->rest : RestChanges();
  std::optional<SurfacePatch> patch;
  if (rest && args.cutout.fill == "surface")
    patch = fill_surface(open.drawer(), labels, changes.ghosts, open.chosen.up_world, open.chosen.given, job);
  refuse_cancelled(job);
  std::optional<MovedTo> to;
  if (placement != ExportPlacement{})
    to = {similarity_of(placement, scene.cloud, labels, open.chosen.up_world, format.axes),
          placement.origin == ExportOrigin::kScene};
  const RestChanges filled = patch ? patch->changes : RestChanges();
  const std::size_t not_given_back = spare_copy(scene, format, to.has_value(), filled, &changes);
  add(filled, &changes);
  const SaveOptions how{.up = up_to_write(open.chosen, placement)};
  const SaveReport saved =
      rest ? save_rest(path, scene, keep, changes, format, to, how)
           : save_gaussians(path, scene, keep, cleaned ? &clean->cloud : nullptr, format, to, how);
  nlohmann::json reply = clean_json(clean ? std::optional(clean->report) : std::nullopt);
  reply.update({{"gaussians", saved.gaussians}, {"bytes", saved.bytes}, {"path", path.string()}});
  if (!saved.loss.empty()) reply["loss"] = saved.loss;
  if (patch) reply["fill"] = fill_json(*patch);
  if (not_given_back > 0) reply["not_given_back"] = not_given_back;
  return reply;
}

}  // namespace splatcut
