#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "common/geometry/rigid_fit.h"
#include "common/geometry/rotation.h"
#include "common/importers/import_options.h"
#include "fusion-server/registration/registration.h"
#include "tests/bench/accuracy/recordings.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;
using registration::WalkTrack;

/// The pose that each camera saw, by frame and camera.  A row of the file is "C002 1 0 x y z
/// depthX depthY state": camera, frame, joint, position [m], ...
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

/// Yaw between two cameras from a single pose: what a naive registrar would take for the truth.
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

using Poses = std::map<int, std::map<std::string, Skeleton<SensorSpace>>>;

std::vector<WalkTrack> tracks_of(const Poses& poses) {
  std::vector<WalkTrack> tracks{{SensorId::parse("C002").value(), {}},
                                {SensorId::parse("C003").value(), {}}};
  for (const auto& [frame, cameras] : poses) {
    for (WalkTrack& track : tracks) {
      SensorFrame seen;
      seen.sensor = track.sensor;
      seen.captured = importers::kDefaultStart + frame * Duration(33'333'333);
      seen.bodies = {{BodyId{1}, seen.captured, cameras.at(track.sensor.str())}};
      track.frames.push_back(std::move(seen));
    }
  }
  return tracks;
}

}  // namespace

Result<void> refuse_ntu_poses(Report& report, const fs::path& folder) {
  const Poses poses = read_poses(folder / "three_views" / "raw_C002_C003.txt");
  if (poses.size() < 2) {
    report.condition("ntu: two poses are there", false);
    return {};
  }
  std::vector<double> yaws;
  for (const auto& [frame, cameras] : poses) yaws.push_back(yaw_of_one_pose(cameras));
  const std::vector<WalkTrack> tracks = tracks_of(poses);
  const auto edge = register_pair(tracks[0], tracks[1], {});
  report.row("ntu-three-views", "one_pose_yaw_standing_deg", std::abs(to_deg(yaws.front())), "deg");
  report.row("ntu-three-views", "one_pose_yaw_drinking_deg", std::abs(to_deg(yaws.back())), "deg",
             "standing", yaws.back() / yaws.front());
  report.condition("ntu: two poses are refused: " +
                       (edge ? std::string("they were not") : to_string(edge.error())),
                   !edge);
  return {};
}

}  // namespace chorus::bench
