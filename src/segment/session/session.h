// The one door to a cut: a scene with all that is kept of it between cuts.
//
// Command line, window, eval and study cut through it, so that the same strokes give the same labels. What is
// prepared is a neighbourhood of what was clicked (superpoints/neighbourhood.h), never the scene:
//   1. The first stroke on the object says where: what it hits; as the cell's side the camera's distance, or
//      the usual one (superpoints/usual_picture.h) if it is larger, rounded up to a power of two, or what
//      else holds a Gaussian; half of it again and again while the cell holds more than most_gaussians and
//      the half still holds all that was hit, and a Gaussian. With masks, the box of what they show, twice
//      as large.
//   2. After each stroke, and again after the cut: while what is labelled touches the cell's side, or a
//      stroke on the object hits what lies outside, the next cell is twice as large, about both. A cell
//      that holds most of the scene is the scene. A first answer is shown while it grows. If a later stroke
//      needs the larger cell, the user has seen what the strokes before it gave. So that stays: where these
//      strokes would mean something else there, their labels are carried over, leaf by leaf. Other meanings
//      of the first click, mostly one of which is the floor or a wall, make the cell grow when they are
//      taken: they are offered where the likeliest is answered, and found again in the larger cell by their
//      labels. So are other sizes of the last stroke, each a step from the one before, in the cell in which
//      that is answered.
// Strokes on the rest that hit nothing of the cell change nothing: there is no object there. A path on the
// rest counts as the pieces of it that hit the cell. Cuts from pixels alone (the baselines) look at the whole
// scene. What a request asks for among some of the Gaussians is asked of a session on these
// (session_among.h), as other files of a scene change no answer of before.
// The result is a function of scene, request and settings alone, kept steps or not, whatever was cut before,
// on any number of threads. The neighbourhoods used last are kept within most_bytes, with all that is known
// of cuts in them; of those used longest ago the pictures go first. One call at a time.
#pragma once

#include <list>
#include <map>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/job.h"
#include "core/oldest_first.h"
#include "segment/session/cut_request.h"
#include "segment/session/cut_result.h"
#include "segment/session/cut_settings.h"
#include "segment/session/local_session.h"
#include "segment/session/stroke_hits.h"
#include "segment/superpoints/neighbourhood.h"

namespace splatcut {

struct KeptNeighbourhood;  // a neighbourhood and the session on it
struct SessionAmong;       // a session on some of the Gaussians

struct SessionScene {
  std::shared_ptr<const GaussianCloud> cloud;
  std::shared_ptr<const CloudBlocks> blocks{};  // of the cloud; null: the session makes them
  glm::vec3 up_world{0, -1, 0};                 // for orbits; a request may know better
  std::vector<Camera> photographs{};            // cameras of the capture, where known
  PrepareOptions prepare{};
  std::size_t most_gaussians = 150'000;             // in the first cell
  std::size_t most_ahead = 250'000;                 // prepared for a cut of CutReach::kSmall
  std::size_t most_bytes = std::size_t{768} << 20;  // kept; the neighbourhood in use may be larger
};

// Where a cut may go. kSmall: it prepares no neighbourhood of more than SessionScene::most_ahead, and
// ends as if cancelled where it would have to.
enum class CutReach { kAnywhere, kSmall };

class Session {
 public:
  explicit Session(SessionScene scene);
  ~Session();
  Session(Session&& other) noexcept;

  const SessionScene& scene() const { return scene_; }
  const CloudBlocks& blocks() const { return *whole_.blocks; }  // of the scene's cloud

  // Throws Error for settings that contradict each other, or parts that the scene is not prepared with.
  // Nothing marked, nothing found, cancelled: in `outcome`, with a reason.
  CutResult cut(const CutRequest& request, const CutSettings& settings, const Job& job = {},
                const OnSnapshot& on_snapshot = {}, CutReach reach = CutReach::kAnywhere);

  // The reference's mask alone, before any other view is looked at, in the size of
  // limited_to_width(reference, work_width_px) or larger; empty where nothing marks the object.
  Mask first_mask(const CutRequest& request, const CutSettings& settings, const Job& job = {});

  // Labels before and after one more stroke, by parts alone, with the code of cut()'s first mask. Costs some
  // 10 ms where place and view are known. Empty: cancelled, the settings know no parts, or nothing is hit.
  struct Preview {
    std::vector<std::uint8_t> before, after;
  };
  Preview preview(const CutRequest& request, const CameraStroke& stroke, const CutSettings& settings,
                  const Job& job = {});

  // w_g as the last cut of `request` weighed it, for display: soft or hard, with corrections and what the
  // parts say; 0 outside of its neighbourhood. Cancelled, or nothing marked: unspecified.
  std::vector<float> likelihood_of(const CutRequest& request, const CutSettings& settings,
                                   const Job& job = {});

  // Builds ahead what a first click there needs.
  void make_ready(const CameraStroke& click, const CutSettings& settings, const Job& job = {});

  // At most `views` views around a cut object to look from, each with the mask of its labels; cameras as
  // cut() would try them first. They influence no cut. Excludes the result's own views and those that show
  // nothing of the object, nor of what it was before: labels, or empty. Cancelled: must not be used.
  std::vector<GivenView> look_around(const CutRequest& request, const CutResult& result,
                                     const CutSettings& settings, int views, const Job& job = {},
                                     std::span<const std::uint8_t> before = {});

  std::size_t neighbourhoods() const { return locals_.size(); }  // that are kept
  std::size_t kept_bytes() const;  // of these, with all that is kept of cuts in them

 private:
  using Local = KeptNeighbourhood;
  // Where a request is answered, and which of the meanings and sizes that its strokes have there it takes.
  // What the first strokes say, in replay order, as it was shown before later ones needed a larger place.
  struct Carried {
    std::size_t strokes = 0;                                   // so many of them; 0: none
    std::shared_ptr<const std::vector<std::uint32_t>> rows{};  // of the scene that are object, ascending
  };
  struct Answered {
    Place place;
    int choice = 0;  // as in CutRequest
    std::vector<int>
        size_steps{};  // Stroke::size_step of the strokes in replay order; the others have their own
    Carried carried{};
  };
  static constexpr std::size_t kMostPlaces = 4096, kMostPlaceBytes = std::size_t{64} << 20;

  SessionAmong* among(const CutRequest& request);
  const StrokeHits& hits(const CameraStroke& stroke, const Job& job);
  bool is_whole(const Cell& cell) const;
  std::size_t gaussians_in(const Place& place) const;
  static Place seen_from(const Camera& eye, const glm::vec3& point_world);
  Place first_place(const Camera& eye, const Box& must_hold) const;
  Place place_of_all(const Camera& eye) const;
  Place place_of_masks(const CutRequest& request, const CutSettings& settings, const Job& job) const;
  Place grown(const Place& place, const Box& must_hold) const;
  Place grown_about(const Neighbourhood& near, std::span<const std::uint8_t> labels) const;
  std::optional<Answered> place_of_strokes(const CutRequest& request, const CutSettings& settings,
                                           const Job& job);
  Answered stepped(const CutRequest& request, const CutSettings& settings, Answered answered,
                   const std::string& own_key, int step, const Box& must_hold, const Job& job);
  bool at_last_size(const CutRequest& request, const CutSettings& settings, const Answered& answered,
                    bool larger, const Job& job);
  Answered place_after(const CutRequest& request, const CutSettings& settings, Answered there,
                       const Box& must_hold, const Job& job);
  std::optional<Answered> place_of(const CutRequest& request, const CutSettings& settings, const Job& job);
  std::optional<Answered> answered_in(const Place& larger, const Answered& here, const CutRequest& request,
                                      const CutSettings& settings, const Job& job);
  std::optional<Answered> first_answered_in(const Place& larger, const Answered& here,
                                            const CutRequest& request, const CutSettings& settings,
                                            const Job& job);
  int step_in(Answered there, const Answered& here, const CutRequest& before, const CutRequest& after,
              const CutSettings& settings, const Job& job);
  void keep_offer(const CutRequest& request, const Answered& answered, const CutSettings& settings,
                  const Job& job, CutResult* result);
  void keep_place(const std::string& key, const Answered& answered);
  void keep_within_bytes();
  Local* local(const Place& place, const CutSettings& settings, const Job& job);
  CutRequest in_place(const CutRequest& request, const Answered& answered, Local* there, const Job& job);
  CutResult in_scene(const Local& there, CutResult result) const;
  CutResult cut_anywhere(const CutRequest& request, const CutSettings& settings, const Job& job,
                         const OnSnapshot& on_snapshot);
  Local* settled(const CutRequest& request, const CutSettings& settings, const Job& job,
                 const OnSnapshot& on_snapshot, CutResult* result, Answered* in = nullptr);

  SessionScene scene_;
  WholeScene whole_;
  std::list<SessionAmong> among_;    // used last first
  std::list<Local> locals_;          // used last first
  std::vector<StageTime> prepared_;  // stages of what the cut under way has prepared
  OldestFirst<Answered> places_{kMostPlaces, kMostPlaceBytes};  // of strokes so far, by their bytes
  std::map<std::string, StrokeHits> hits_;                      // of single strokes
  StrokeHits cancelled_hits_;                                   // the last that were not finished
  std::stop_source* ends_if_large_ = nullptr;  // ends a cut of CutReach::kSmall; null: none is under way
};

}  // namespace splatcut
