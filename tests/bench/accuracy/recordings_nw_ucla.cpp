#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/importers/datasets/nw_ucla_json.h"
#include "common/importers/import_options.h"
#include "fusion-server/registration/registration.h"
#include "tests/bench/accuracy/recordings.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;
using record::FrameRecording;
using registration::WalkTrack;

using Views = std::map<std::string, FrameRecording>;  ///< By "v01", "v02", "v03".

std::map<std::string, Views> read_takes(const fs::path& folder) {
  std::map<std::string, Views> takes;
  for (const auto& file : fs::recursive_directory_iterator(folder)) {
    const std::string name = file.path().stem().string();  // aAA_sSS_eEE_vVV
    if (file.path().extension() != ".json" || name.size() != 15) continue;
    auto view = importers::read_nw_ucla_json(file.path());
    if (view) takes[name.substr(0, 11)].emplace(name.substr(12), std::move(*view));
  }
  return takes;
}

bool same_numbers(const FrameRecording& a, const FrameRecording& b) {
  if (a.frames.size() != b.frames.size()) return false;
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (a.frames[f].bodies.at(0).skeleton.joints[j].position !=
          b.frames[f].bodies.at(0).skeleton.joints[j].position) {
        return false;
      }
    }
  }
  return true;
}

/// Registers two views of a take without clocks: tries start shifts of up to 30 frames (a second)
/// in steps of two frames and keeps the best fit.
std::optional<PairwiseRegistration> register_unclocked(const FrameRecording& target,
                                                       const FrameRecording& source) {
  registration::RegistrationConfig config;
  config.use_floor = false;
  config.min_pairs = 12;
  config.min_spread = 0.05;
  config.max_edge_rms = 0.5;
  std::optional<PairwiseRegistration> best;
  for (int lag = -30; lag <= 30; lag += 2) {
    WalkTrack moved{source.sensor, source.frames};
    for (SensorFrame& frame : moved.frames) {
      frame.captured += lag * Duration(33'333'333);
      for (BodyFrame& body : frame.bodies) body.captured = frame.captured;
    }
    const auto edge = register_pair({target.sensor, target.frames}, moved, config);
    if (edge && (!best || edge->rms < best->rms)) best = *edge;
  }
  return best;
}

/// True if the product, as configured, accepts these clips without clocks as a registered pair.
bool accepts(const FrameRecording& target, const FrameRecording& source) {
  registration::RegistrationConfig config;
  config.use_floor = false;  // Kinect v1 delivers no floor
  const auto edge =
      register_pair({target.sensor, target.frames}, {source.sensor, source.frames}, config);
  return edge.has_value();
}

struct Closure {
  std::vector<double> yaw;  ///< |yaw(12) + yaw(23) - yaw(13)| [rad]
  std::vector<double> rms;  ///< [m]
};

void close_chain(const Views& views, Closure& closure) {
  const auto a = register_unclocked(views.at("v01"), views.at("v02"));
  const auto b = register_unclocked(views.at("v02"), views.at("v03"));
  const auto c = register_unclocked(views.at("v01"), views.at("v03"));
  if (!a || !b || !c) return;
  const auto yaw = [](const PairwiseRegistration& edge) {
    return yaw_of(edge.target_from_source.linear());
  };
  closure.yaw.push_back(std::abs(wrap_angle(yaw(*a) + yaw(*b) - yaw(*c))));
  for (const auto* edge : {&*a, &*b, &*c}) closure.rms.push_back(edge->rms);
}

/// Counts over all takes.
struct Census {
  std::size_t complete = 0;  ///< Takes with all three views.
  std::size_t copies = 0;    ///< Complete takes of which two views have the same numbers.
  std::size_t refused = 0;   ///< Of these, takes that the importer refuses as copies.
  std::size_t wrongly = 0;   ///< Complete takes without copies that the importer refuses as copies.
  std::size_t pairs = 0;     ///< Pairs of views of a walk.
  std::size_t accepted = 0;  ///< Pairs that were accepted as registered.
  Closure closure;
};

/// Counts a complete take; returns false if two of its views are the same.
bool count_copies(const Views& views, Census& census) {
  const FrameRecording& a = views.at("v01");
  const FrameRecording& b = views.at("v02");
  const FrameRecording& c = views.at("v03");
  const bool copied = same_numbers(b, c) || same_numbers(a, b) || same_numbers(a, c);
  const bool said = !importers::refuse_copies({a, b, c});
  ++census.complete;
  census.copies += copied ? 1 : 0;
  census.refused += copied && said ? 1 : 0;
  census.wrongly += !copied && said ? 1 : 0;
  return !copied;
}

void count_walk(const Views& views, Census& census) {
  close_chain(views, census.closure);
  for (const auto& [a, b] : {std::pair{"v01", "v02"}, {"v02", "v03"}, {"v01", "v03"}}) {
    ++census.pairs;
    census.accepted += accepts(views.at(a), views.at(b)) ? 1 : 0;
  }
}

double ratio(std::size_t part, std::size_t whole) {
  return whole == 0 ? kNoRatio : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

Result<void> close_nw_ucla_chains(Report& report, const fs::path& folder) {
  Census census;
  for (const auto& [name, views] : read_takes(folder)) {
    if (views.size() != 3) continue;
    const bool walking = name.starts_with("a04");
    if (count_copies(views, census) && walking) count_walk(views, census);
  }
  const auto count = [](std::size_t number) { return static_cast<double>(number); };
  constexpr double kWarpedDeg = 5.0;  // what warping time by hand achieved on these chains
  const double yaw = to_deg(median(census.closure.yaw));
  report.row("nw-ucla", "complete_takes", count(census.complete), "takes");
  report.row("nw-ucla", "copied_cameras_refused", count(census.refused), "takes", "copied-cameras",
             ratio(census.refused, census.copies));
  report.row("nw-ucla", "wrongly_refused", count(census.wrongly), "takes");
  report.row("nw-ucla", "chains_closed", count(census.closure.yaw.size()), "takes");
  report.row("nw-ucla", "chain_yaw_closure_p50_deg", yaw, "deg", "time-warping-by-hand",
             yaw / kWarpedDeg);
  report.row("nw-ucla", "chain_yaw_closure_p90_deg", to_deg(percentile(census.closure.yaw, 0.9)),
             "deg");
  report.row("nw-ucla", "edge_rms_p50_mm", to_mm(median(census.closure.rms)), "mm");
  report.row("nw-ucla", "pairs_accepted_by_default", count(census.accepted), "pairs", "all-pairs",
             ratio(census.accepted, census.pairs));
  report.condition("nw-ucla: every copied camera is refused and no other",
                   census.complete > 0 && census.refused == census.copies && census.wrongly == 0);
  return {};
}

}  // namespace chorus::bench
