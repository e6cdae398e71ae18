// chorus-bench recordings: real Kinect recordings that may not travel with the project, read from
// ../shared/data (or $CHORUS_SHARED/data) and left out, saying so, where that is absent.
//
// Nothing is tuned on them.  KERAAL: Kinect v2 beside optical targets.  NW-UCLA: three cameras of
// one take without clocks.  NTU: three views of one pose.  LabanotationSuite: capture times.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/rigid_fit.h"
#include "common/geometry/rotation.h"
#include "common/importers/import_options.h"
#include "common/importers/labanotation_csv.h"
#include "common/importers/nw_ucla_json.h"
#include "fusion-server/registration/registration.h"
#include "tests/bench/recordings_keraal.h"
#include "tests/bench/report.h"
#include "tests/bench/statistics.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;
using record::FrameRecording;
using registration::WalkTrack;

fs::path shared_folder() {
  const char* given = std::getenv("CHORUS_SHARED");
  return fs::path(given != nullptr ? given : "../shared") / "data";
}

// --- NW-UCLA -----------------------------------------------------------------------------------

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

/// No clock: views are tried with every start shift up to a second, and the best fit is kept.
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

/// Does the product, as it is configured, take these clockless clips for a registered pair?
bool accepts(const FrameRecording& target, const FrameRecording& source) {
  registration::RegistrationConfig config;
  config.use_floor = false;  // Kinect v1 gives none
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

void nw_ucla(Report& report, const fs::path& folder) {
  std::size_t complete = 0;
  std::size_t copies = 0;
  std::size_t refused = 0;
  std::size_t wrongly = 0;
  std::size_t pairs = 0;
  std::size_t accepted = 0;
  Closure closure;
  for (const auto& [name, views] : read_takes(folder)) {
    if (views.size() != 3) continue;
    ++complete;
    const bool copied = same_numbers(views.at("v02"), views.at("v03")) ||
                        same_numbers(views.at("v01"), views.at("v02")) ||
                        same_numbers(views.at("v01"), views.at("v03"));
    const bool said =
        !importers::refuse_copies({views.at("v01"), views.at("v02"), views.at("v03")});
    copies += copied ? 1 : 0;
    refused += copied && said ? 1 : 0;
    wrongly += !copied && said ? 1 : 0;
    if (copied || !name.starts_with("a04")) continue;  // a04: walking about
    close_chain(views, closure);
    for (const auto& [a, b] : {std::pair{"v01", "v02"}, {"v02", "v03"}, {"v01", "v03"}}) {
      ++pairs;
      accepted += accepts(views.at(a), views.at(b)) ? 1 : 0;
    }
  }
  report.row("nw-ucla", "complete_takes", static_cast<double>(complete), "takes");
  report.row("nw-ucla", "copied_cameras_refused", static_cast<double>(refused), "takes",
             fmt::format("copies {}", copies));
  report.row("nw-ucla", "wrongly_refused", static_cast<double>(wrongly), "takes");
  report.row("nw-ucla", "chains_closed", static_cast<double>(closure.yaw.size()), "takes");
  report.row("nw-ucla", "chain_yaw_closure_p50_deg", to_deg(median(closure.yaw)), "deg",
             "5 by hand-made time warping");
  report.row("nw-ucla", "chain_yaw_closure_p90_deg", to_deg(percentile(closure.yaw, 0.9)), "deg");
  report.row("nw-ucla", "edge_rms_p50_mm", to_mm(median(closure.rms)), "mm");
  report.row("nw-ucla", "pairs_accepted_by_default", static_cast<double>(accepted), "pairs",
             fmt::format("of {}", pairs));
  report.condition("nw-ucla: every copied camera is refused and no other",
                   complete > 0 && refused == copies && wrongly == 0);
}

// --- NTU ---------------------------------------------------------------------------------------

/// Frame -> camera -> the pose it saw ("C002 1 0 x y z depthX depthY state").
std::map<int, std::map<std::string, Skeleton<SensorSpace>>> read_poses(const fs::path& file) {
  std::map<int, std::map<std::string, Skeleton<SensorSpace>>> poses;
  std::ifstream text(file);
  for (std::string line; std::getline(text, line);) {
    std::istringstream row(line);
    std::string camera;
    int frame = 0;
    std::size_t joint = 0;
    Eigen::Vector3d at;
    if (line.starts_with('#') || !(row >> camera >> frame >> joint >> at.x() >> at.y() >> at.z()) ||
        joint >= kJointCount) {
      continue;
    }
    poses[frame][camera].joints[joint] = {at, Eigen::Quaterniond(0, 0, 0, 0), JointState::Tracked};
  }
  return poses;
}

/// Yaw between two cameras from one pose: what a naive registrar would take for the truth.
double yaw_of_one_pose(const std::map<std::string, Skeleton<SensorSpace>>& pose) {
  std::vector<Eigen::Vector3d> target;
  std::vector<Eigen::Vector3d> source;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    target.push_back(pose.at("C002").joints[j].position);
    source.push_back(pose.at("C003").joints[j].position);
  }
  const auto fitted = fit_rigid(source, target);
  return fitted ? yaw_of(fitted->target_from_source.linear()) : std::nan("");
}

void ntu(Report& report, const fs::path& folder) {
  const auto poses = read_poses(folder / "three_views" / "raw_C002_C003.txt");
  if (poses.size() < 2) return report.condition("ntu: two poses are there", false);
  std::vector<WalkTrack> tracks{{SensorId::parse("C002").value(), {}},
                                {SensorId::parse("C003").value(), {}}};
  std::vector<double> yaws;
  for (const auto& [frame, cameras] : poses) {
    yaws.push_back(yaw_of_one_pose(cameras));
    for (WalkTrack& track : tracks) {
      SensorFrame seen;
      seen.sensor = track.sensor;
      seen.captured = importers::kDefaultStart + frame * Duration(33'333'333);
      seen.bodies = {{BodyId{1}, seen.captured, cameras.at(track.sensor.str())}};
      track.frames.push_back(std::move(seen));
    }
  }
  const auto edge = register_pair(tracks[0], tracks[1], {});
  report.row("ntu-three-views", "one_pose_yaw_standing_deg", std::abs(to_deg(yaws.front())), "deg");
  report.row("ntu-three-views", "one_pose_yaw_drinking_deg", std::abs(to_deg(yaws.back())), "deg",
             "standing", yaws.back() / yaws.front());
  report.condition("ntu: two poses are refused: " +
                       (edge ? std::string("they were not") : to_string(edge.error())),
                   !edge);
}

// --- LabanotationSuite ---------------------------------------------------------------------------

void labanotation(Report& report, const fs::path& folder) {
  std::vector<double> steps;  // [s]
  std::size_t frames = 0;
  for (const auto& file : fs::recursive_directory_iterator(folder)) {
    if (file.path().extension() != ".csv") continue;
    const auto clip = importers::read_labanotation_csv(file.path());
    if (!clip) continue;
    frames += clip->frames.size();
    for (std::size_t i = 1; i < clip->frames.size(); ++i) {
      steps.push_back(seconds(clip->frames[i].captured - clip->frames[i - 1].captured));
    }
  }
  const auto doubled = std::count_if(steps.begin(), steps.end(), [](double s) { return s > 0.05; });
  const double lost =
      static_cast<double>(doubled) / static_cast<double>(std::max<std::size_t>(1, steps.size()));
  report.row("labanotation", "frames", static_cast<double>(frames), "frames");
  report.row("labanotation", "step_p50_ms", 1e3 * median(steps), "ms", "profile A 33.3",
             median(steps) / (1.0 / 30.0));
  report.row("labanotation", "step_p99_ms", 1e3 * percentile(steps, 0.99), "ms");
  report.row("labanotation", "lost_percent", 100.0 * lost, "%", "profile A 0.5 to 2");
  report.condition("labanotation: steps are 30 Hz within 5 %",
                   std::abs(median(steps) * 30.0 - 1.0) < 0.05);
}

}  // namespace

Result<void> run_recordings(Report& report) {
  const fs::path data = shared_folder();
  struct Part {
    const char* folder;
    std::function<Result<void>(const fs::path&)> run;
  };
  const std::array<Part, 4> parts{{
      {"keraal_kinect2_optical",
       [&](const fs::path& at) { return compare_with_keraal(report, at); }},
      {"nw_ucla_3kinect",
       [&](const fs::path& at) -> Result<void> { return nw_ucla(report, at), Result<void>{}; }},
      {"ntu_rgbd_kinect2",
       [&](const fs::path& at) -> Result<void> { return ntu(report, at), Result<void>{}; }},
      {"kinect2_labanotation",
       [&](const fs::path& at) -> Result<void> {
         return labanotation(report, at), Result<void>{};
       }},
  }};
  for (const Part& part : parts) {
    const fs::path folder = data / part.folder;
    if (!fs::is_directory(folder)) {
      report.note(fmt::format("left out: {} is not here", part.folder));
      continue;
    }
    if (auto done = part.run(folder); !done) return done;
  }
  report.note(
      "Real recordings; nothing in Chorus was tuned on them.  KERAAL's targets sit on the skin, "
      "some centimetres from joint centres: the first row says so, the second takes each "
      "target's mean place off.  NW-UCLA has no clocks and trimmed clips.");
  return {};
}

}  // namespace chorus::bench
