// PETS 2009 S2.L1: people who walk 20 to 30 m before one calibrated camera, 7 Hz; nobody wears a
// suit, so the pose is a gait's that is nearest to the outline.  The first place and the direction
// of the first step are told, as in the paper; then nothing is.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "common/geometry/rotation.h"
#include "common/motion/cmu_walk.h"
#include "common/positioning/outline_sight.h"
#include "common/sensor/pixel_ray.h"
#include "tests/bench/positioner/positioner_cases.h"

namespace chorus::bench {
namespace {

constexpr double kPetsRate = 7.0;  // [Hz]
constexpr double kPetsStature = 1.75;
constexpr int kPhases = 4;  // Of the gait that are tried.

/// View_001 by Tsai's model in OpenCV's terms: f sx / dpx, f / dpy, and -kappa1 f^2 for k1.
const Intrinsics kPetsLens{768, 576, 1185.0013, 1194.6061, 324.2215, 282.5665, {-0.15772}};

/// World of the dataset (x, y over the ground, z up) to ours.
Eigen::Vector3d ours(double x, double y) { return {x, 0.0, -y}; }

Eigen::Isometry3d pets_camera() {
  Eigen::Isometry3d camera_from_tsai = Eigen::Isometry3d::Identity();
  camera_from_tsai.linear() = (Eigen::AngleAxisd(-0.43056124791, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(-0.89337703748, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(2.0405458695, Eigen::Vector3d::UnitX()))
                                  .toRotationMatrix();
  camera_from_tsai.translation() << 0.82873214, -3.17547960, 35.46929855;
  Eigen::Isometry3d ours_from_tsai = Eigen::Isometry3d::Identity();
  ours_from_tsai.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  Eigen::Isometry3d out = ours_from_tsai * camera_from_tsai.inverse();
  out.linear() = out.linear() * camera_from_sensor_axes();
  return out;
}

using PetsPaths = std::map<int, std::map<int, Eigen::Vector3d>>;  ///< By person and frame.

PetsPaths read_paths(const std::filesystem::path& file) {
  std::ifstream in(file);
  PetsPaths out;
  int frame = 0;
  int person = 0;
  double x = 0.0;
  double y = 0.0;
  while (in >> frame >> person >> x >> y) out[person][frame] = ours(x, y);
  return out;
}

/// Poses of one stride, walking along +z.
std::vector<suit::SuitPose> gait() {
  const motion::CmuWalk& cmu = motion::cmu_walk();
  const auto walk = motion::motion_from_amc(cmu.skeleton, cmu.takes.front());
  const suit::SuitTake take = suit::take_of(*walk, kPetsStature).value();
  const Eigen::Vector3d way = take.claimed.back() - take.claimed.front();
  const double heading = std::atan2(way.x(), way.z());
  std::vector<suit::SuitPose> out;
  for (int i = 0; i < kPhases; ++i) {
    const suit::SuitPose pose = suit::pose_at(take, from_seconds(1.0 + 0.28 * i));
    out.push_back(suit::pose_of(suit::placed(pose, -heading, {0, 0, 0}), Duration{0}));
  }
  return out;
}

double hips_height(const suit::SuitPose& pose) {
  double lowest = 0.0;
  for (const Joint& joint : pose.joints.joints)
    if (joint.seen()) lowest = std::min(lowest, joint.position.y());
  return -lowest + 0.03;
}

struct PetsWalker {
  Eigen::Vector3d place;
  Eigen::Vector3d velocity;  ///< [m/s]
  int unseen = 0;
};

using PetsAsk = std::optional<positioning::SightedPlace> (positioning::PictureSight::*)(
    const positioning::ExpectedBody&) const;

/// One picture: on by the velocity, then to the phase of the gait that fits best.
void follow(PetsWalker& walker, const positioning::PictureSight& sight,
            const std::vector<suit::SuitPose>& phases, PetsAsk ask) {
  const Eigen::Vector3d expected = walker.place + walker.velocity / kPetsRate;
  const double heading = std::atan2(walker.velocity.x(), walker.velocity.z());
  std::optional<positioning::SightedPlace> best;
  for (const suit::SuitPose& pose : phases) {
    Eigen::Vector3d at = expected;
    at.y() = hips_height(pose);
    const auto seen = (sight.*ask)({pose, heading, at});
    if (seen && (!best || seen->misfit_px < best->misfit_px)) best = seen;
  }
  constexpr double kFarthestStep = 0.6;  // [m]
  ++walker.unseen;
  walker.place = expected;
  if (!best || (best->place - expected).head<3>().cwiseProduct(Eigen::Vector3d(1, 0, 1)).norm() >
                   kFarthestStep)
    return;
  walker.unseen = 0;
  Eigen::Vector3d off = best->place - expected;
  off.y() = 0.0;
  // Alpha-beta: half of the place, an eighth of the velocity.
  walker.place += 0.5 * off;
  walker.velocity += 0.125 * kPetsRate * off;
}

struct PetsScore {
  std::vector<double> errors;
  std::size_t asked = 0;
};

Result<PetsScore> followed(const std::filesystem::path& folder, PetsAsk ask, int frames) {
  const PetsPaths paths = read_paths(folder / "TrajNet/Train/mot/PETS09-S2L1.txt");
  const std::string video = (folder / "vtest.avi").string();
  silhouette::Background room({.scale = 1.0, .farthest = 20.0});
  const auto small = [](const cv::Mat& picture) {
    cv::Mat out;
    cv::resize(picture, out, {positioning::kSightWidth, 480}, 0.0, 0.0, cv::INTER_AREA);
    return out;
  };
  cv::Mat picture;
  for (cv::VideoCapture film(video); film.read(picture);) room.learn(small(picture));
  if (room.learned() == 0) return fail(ErrorCode::NotFound, video, "cannot be read");
  const positioning::SightCamera camera{pets_camera(), positioning::sight_lens(kPetsLens),
                                        silhouette::usual_shape(kPetsStature)};
  const std::vector<suit::SuitPose> phases = gait();
  std::map<int, PetsWalker> walkers;
  PetsScore out;
  cv::VideoCapture film(video);
  for (int frame = 0; frame < frames && film.read(picture); ++frame) {
    const auto sight = positioning::outline_sight(camera, room.evidence(small(picture)).value());
    for (const auto& [person, path] : paths) {
      const auto now = path.find(frame);
      if (frame > path.rbegin()->first) walkers.erase(person);
      if (frame == path.begin()->first && path.size() > 4) {
        const auto later = std::next(path.begin(), 2);
        walkers[person] = {now->second, (later->second - now->second) * kPetsRate /
                                            (later->first - path.begin()->first)};
        continue;
      }
      const auto walker = walkers.find(person);
      if (walker == walkers.end()) continue;
      follow(walker->second, *sight, phases, ask);
      if (now == path.end()) continue;
      ++out.asked;
      constexpr int kForgotten = 14;  // Two seconds without an outline.
      if (walker->second.unseen > kForgotten) continue;
      Eigen::Vector3d off = walker->second.place - now->second;
      off.y() = 0.0;
      out.errors.push_back(off.norm());
    }
  }
  return out;
}

}  // namespace

Result<void> pets_walkers(Report& report) {
  const char* const stated = std::getenv("CHORUS_PETS");
  if (stated == nullptr) {
    report.note("pets: left out; CHORUS_PETS names the folder with vtest.avi and TrajNet/");
    return {};
  }
  const int frames = report.quick() ? 60 : 795;
  for (const auto& [name, ask] :
       {std::pair<std::string, PetsAsk>{"silhouettes", &positioning::PictureSight::searched},
        std::pair<std::string, PetsAsk>{"outline", &positioning::PictureSight::outlined}}) {
    auto score = followed(stated, ask, frames);
    if (!score) return pass(score);
    auto errors = score->errors;
    std::sort(errors.begin(), errors.end());
    if (errors.empty()) continue;
    const auto count = static_cast<double>(errors.size());
    const auto lost = std::count_if(errors.begin(), errors.end(), [](double e) { return e > 1.0; });
    report.row("pets/" + name, "median_m", errors[errors.size() / 2], "m");
    report.row("pets/" + name, "p90_m", errors[9 * errors.size() / 10], "m");
    report.row("pets/" + name, "answered_percent",
               100.0 * count / static_cast<double>(score->asked), "%");
    report.row("pets/" + name, "beyond_1m_percent", 100.0 * static_cast<double>(lost) / count, "%");
  }
  return {};
}

}  // namespace chorus::bench
