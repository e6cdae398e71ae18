// UI-PRMD: one Kinect v2 and Vicon at once (s01-s05).  Each clip begins in the person's own stance:
// its first half second is taken off on both sides.
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/rigid_fit.h"
#include "common/importers/formats.h"
#include "common/importers/text_rows.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/ergonomics/ergonomics_cases.h"
#include "tests/bench/ergonomics/posture_agreement.h"

namespace chorus::bench::clips {
namespace {

namespace fs = std::filesystem;
using enum JointId;
using Eigen::Vector3d;
using Rows = std::vector<std::vector<Vector3d>>;
using Body = Skeleton<WorldSpace>;

constexpr auto kFolder = "../shared/data/uiprmd_kinect_vicon";
constexpr double kKinectHz = 30.0;
constexpr double kMarkerHz = 100.0;
constexpr std::size_t kJoints = 22;
constexpr std::size_t kMarkers = 39;
constexpr double kSensorHeight = 1.0;     // [m]; not published
constexpr double kHipBelowSpines = 0.09;  // [m]: hip centres lie below the iliac spines' middle
constexpr std::array<int, kJoints> kParents{-1, 0,  1,  2, 3,  4,  2,  6, 7,  8,  2,
                                            10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20};

/// Our joint, its number in the Kinect's files, and the markers whose mean is its place.
struct Pair {
  JointId joint;
  std::size_t kinect;
  std::array<int, 4> markers;
};
constexpr std::array kPairs{Pair{ShoulderLeft, 7, {9, -1, -1, -1}},
                            Pair{ElbowLeft, 8, {11, -1, -1, -1}},
                            Pair{WristLeft, 9, {13, 14, -1, -1}},
                            Pair{ShoulderRight, 11, {16, -1, -1, -1}},
                            Pair{ElbowRight, 12, {18, -1, -1, -1}},
                            Pair{WristRight, 13, {20, 21, -1, -1}},
                            Pair{HipLeft, 14, {23, 25, -1, -1}},
                            Pair{KneeLeft, 15, {28, -1, -1, -1}},
                            Pair{AnkleLeft, 16, {30, -1, -1, -1}},
                            Pair{HipRight, 18, {24, 26, -1, -1}},
                            Pair{KneeRight, 19, {34, -1, -1, -1}},
                            Pair{AnkleRight, 20, {36, -1, -1, -1}},
                            Pair{Head, 4, {0, 1, 2, 3}}};

Result<std::string> unpacked(const fs::path& file) {
  gzFile const packed = gzopen(file.c_str(), "rb");
  if (packed == nullptr) return fail(ErrorCode::NotFound, file.string(), "cannot be read");
  std::string text;
  std::array<char, 1U << 16U> part{};
  int count = 0;
  while ((count = gzread(packed, part.data(), part.size())) > 0)
    text.append(part.data(), static_cast<std::size_t>(count));
  gzclose(packed);
  if (count == 0) return text;
  return fail(ErrorCode::Malformed, file.string(), "is no whole gzip file");
}

Result<Rows> read_rows(const fs::path& file, std::size_t points) {
  const auto text = unpacked(file);
  if (!text) return pass(text);
  importers::LineReader lines(*text, file.string());
  Rows rows;
  while (const auto line = lines.next_filled()) {
    const auto row = importers::Row::split(lines, *line, ',', 3 * points);
    if (!row) return pass(row);
    std::vector<double> numbers(3 * points);
    if (auto ok = row->numbers(0, numbers, 1e5); !ok) return pass(ok);
    auto& found = rows.emplace_back();
    for (std::size_t i = 0; i < points; ++i)
      found.emplace_back(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
  }
  return rows;
}

void put(Body& body, JointId id, const Vector3d& at) {
  body[id].position = at;
  body[id].state = JointState::Tracked;
}

void add_spine(Body& body) {
  const auto middle = [&](JointId a, JointId b) {
    return Vector3d(0.5 * (body[a].position + body[b].position));
  };
  put(body, SpineBase, middle(HipLeft, HipRight));
  put(body, SpineShoulder, middle(ShoulderLeft, ShoulderRight));
  put(body, SpineMid, middle(SpineBase, SpineShoulder));
  put(body, Neck,
      Vector3d(body[SpineShoulder].position +
               (body[Head].position - body[SpineShoulder].position) / 3.0));
}

/// In sensor space: the files' -z is the depth.
Body kinect_body(const std::vector<Vector3d>& places, const std::vector<Vector3d>& angles) {
  std::array<Eigen::Isometry3d, kJoints> joints;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const Vector3d turn = angles[i] * deg(1);
    Eigen::Isometry3d own = Eigen::Isometry3d::Identity();
    own.translation() = 0.01 * places[i];
    own.linear() = (Eigen::AngleAxisd(turn.z(), Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(turn.x(), Vector3d::UnitX()) *
                    Eigen::AngleAxisd(turn.y(), Vector3d::UnitY()))
                       .toRotationMatrix();
    joints[i] = kParents[i] < 0 ? own : joints[static_cast<std::size_t>(kParents[i])] * own;
  }
  Body body;
  for (const Pair& pair : kPairs) {
    const Vector3d& at = joints[pair.kinect].translation();
    put(body, pair.joint, {-at.x(), at.y() - kSensorHeight, -at.z()});
  }
  add_spine(body);
  return body;
}

/// In Vicon's own axes, z up, turned to y up.
Body marker_body(const std::vector<Vector3d>& markers) {
  Body body;
  for (const Pair& pair : kPairs) {
    Vector3d sum = Vector3d::Zero();
    double count = 0.0;
    for (const int marker : pair.markers) {
      if (marker < 0) continue;
      sum += markers[static_cast<std::size_t>(marker)];
      count += 1.0;
    }
    const Vector3d at = mm(1) * sum / count;
    const double below = pair.joint == HipLeft || pair.joint == HipRight ? kHipBelowSpines : 0.0;
    put(body, pair.joint, {at.x(), at.z() - below, -at.y()});
  }
  add_spine(body);
  return body;
}

struct Clip {
  std::vector<Body> kinect;  ///< At 30 Hz, in sensor space.
  std::vector<Body> vicon;   ///< At 100 Hz.
};

std::optional<std::size_t> marker_frame(const Clip& clip, std::size_t frame, double shift) {
  const double at = std::round((static_cast<double>(frame) / kKinectHz + shift) * kMarkerHz);
  if (at < 0.0 || at >= static_cast<double>(clip.vicon.size())) return std::nullopt;
  return static_cast<std::size_t>(at);
}

/// The shift of time at which one rigid motion fits best: the clips have no common clock.
double best_shift(const Clip& clip) {
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (double shift = -0.6; shift <= 0.6; shift += 0.02) {
    std::vector<Vector3d> source;
    std::vector<Vector3d> target;
    for (std::size_t f = 0; f < clip.kinect.size(); f += 3) {
      const auto at = marker_frame(clip, f, shift);
      if (!at) continue;
      for (const Pair& pair : kPairs) {
        source.push_back(clip.vicon[*at][pair.joint].position);
        target.push_back(clip.kinect[f][pair.joint].position);
      }
    }
    const auto fit = fit_rigid(source, target);
    if (!fit || !(fit->rms < least)) continue;
    least = fit->rms;
    best = shift;
  }
  return best;
}

Result<Clip> read_clip(const std::string& name) {
  const fs::path folder = kFolder;
  const auto places =
      read_rows(folder / "kinect_positions" / (name + "_positions.txt.gz"), kJoints);
  if (!places) return pass(places);
  const auto angles = read_rows(folder / "kinect_angles" / (name + "_angles.txt.gz"), kJoints);
  if (!angles) return pass(angles);
  const auto markers =
      read_rows(folder / "vicon_positions" / (name + "_positions.txt.gz"), kMarkers);
  if (!markers) return pass(markers);
  Clip clip;
  for (std::size_t i = 0; i < std::min(places->size(), angles->size()); ++i)
    clip.kinect.push_back(kinect_body((*places)[i], (*angles)[i]));
  for (const auto& row : *markers) clip.vicon.push_back(marker_body(row));
  return clip;
}

Timestamp instant(std::size_t frame) {
  return importers::kDefaultStart +
         Duration(std::llround(1e9 * static_cast<double>(frame) / kKinectHz));
}

/// The clip through the pipeline as shipped, with one sensor.
Result<std::vector<ergonomics::BodyAt>> fused_clip(const Clip& clip) {
  const SensorId sensor = SensorId::parse("kinect").value();
  registration::WalkTrack track{sensor, {}};
  for (std::size_t f = 0; f < clip.kinect.size(); ++f) {
    SensorFrame frame;
    frame.sensor = sensor;
    frame.sequence = f;
    frame.captured = frame.received = instant(f);
    frame.bodies.push_back(
        {BodyId{1}, frame.captured, Skeleton<SensorSpace>{clip.kinect[f].joints}});
    frame.floor = FloorPlane{Vector3d::UnitY(), kSensorHeight};
    track.frames.push_back(std::move(frame));
  }
  Registration registration;
  registration.version = 1;
  registration.verdict = Verdict::Good;
  registration.master = sensor;
  registration.sensors[sensor].world_from_sensor =
      Eigen::Translation3d(0, kSensorHeight, 0) * Eigen::Isometry3d::Identity();
  pipeline::OfflineConfig config;
  const auto result = pipeline::fuse_offline({track}, registration, config);
  if (!result) return pass(result);
  std::vector<ergonomics::BodyAt> bodies(clip.kinect.size());
  for (std::size_t f = 0; f < bodies.size(); ++f) bodies[f].at = instant(f);
  for (const Snapshot& snapshot : result->snapshots) {
    const double at =
        std::chrono::duration<double>(snapshot.instant - instant(0)).count() * kKinectHz;
    const auto index = static_cast<std::size_t>(std::max(0.0, std::round(at)));
    if (index >= bodies.size() || snapshot.bodies.empty()) continue;
    const FusedBody& fused = snapshot.bodies.front();
    auto& body = bodies[index];
    body.body = fused.skeleton;
    body.carried = fused.carried_for.has_value();
    body.sides_confidence = fused.sides_confidence.value_or(1.0);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      Joint& joint = body.body.joints[j];
      if (!joint.covariance.known() && fused.variance[j] > 0.0)
        joint.covariance = Covariance(Eigen::Matrix3d::Identity() * fused.variance[j]);
    }
  }
  return bodies;
}

Result<std::optional<ScoredTake>> scored_clip(const std::string& name) {
  const auto clip = read_clip(name);
  if (!clip) return pass(clip);
  const auto found = fused_clip(*clip);
  if (!found) return pass(found);
  const double shift = best_shift(*clip);
  ScoredTake take;
  for (std::size_t f = 0; f < found->size(); ++f) {
    const auto at = marker_frame(*clip, f, shift);
    if (!at) continue;
    take.found.push_back((*found)[f]);
    take.truth.push_back({(*found)[f].at, clip->vicon[*at]});
  }
  if (take.found.size() < 30) return std::optional<ScoredTake>{};
  // The first half second in which the tracker has the person.
  const auto first =
      std::ranges::find_if(take.found, [](const auto& body) { return body.body[HipLeft].seen(); });
  if (first == take.found.end()) return std::optional<ScoredTake>{};
  take.stance = std::pair{first->at, first->at + std::chrono::milliseconds(500)};
  return std::optional<ScoredTake>(std::move(take));
}

}  // namespace
}  // namespace chorus::bench::clips

namespace chorus::bench {

Result<void> posture_uiprmd(Report& report) {
  namespace fs = std::filesystem;
  if (!fs::exists(clips::kFolder)) {
    report.note(fmt::format("uiprmd: left out, {} is not there", clips::kFolder));
    return {};
  }
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(fs::path(clips::kFolder) / "kinect_positions")) {
    const std::string name = file.path().filename().string().substr(0, 11);  // "m01_s01_e01"
    if (fs::exists(fs::path(clips::kFolder) / "vicon_positions" / (name + "_positions.txt.gz")))
      names.push_back(name);
  }
  std::ranges::sort(names);
  PostureAgreement held;
  PostureAgreement instant;
  double count = 0.0;
  for (const std::string& name : names) {
    const auto take = clips::scored_clip(name);
    if (!take) return pass(take);
    if (!*take) continue;
    count += 1.0;
    compare_postures(**take, {}, held);
    compare_postures(**take, {.held = false}, instant);
  }
  report.row("uiprmd", "clips", count, "");
  report_agreement(report, "uiprmd", held);
  report_doubt(report, "uiprmd", held);
  report_agreement(report, "uiprmd-instant", instant);
  report_doubt(report, "uiprmd-instant", instant);
  report.condition(fmt::format("uiprmd: REBA level, weighted kappa at least 0.85 (is {:.2f})",
                               held.of[1].weighted_kappa()),
                   held.of[1].weighted_kappa() >= 0.85);
  report.condition(
      fmt::format("uiprmd: REBA level, kappa at least 0.65 (is {:.2f})", held.of[1].kappa()),
      held.of[1].kappa() >= 0.65);
  return {};
}

}  // namespace chorus::bench
