// A real Kinect v2 judged by optical targets on the limbs (KERAAL, exercise CTK, one take of 6.5
// s): a target stands for a sensor without an error of its own.
#include <array>
#include <cmath>
#include <sstream>

#include "common/base/file.h"
#include "common/base/parse.h"
#include "common/evaluation/calibrate.h"
#include "common/evaluation/limb_error.h"
#include "common/evaluation/limb_frame.h"
#include "common/geometry/rigid_fit.h"
#include "common/geometry/rotation.h"
#include "tests/bench/inertial/inertial_cases.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

namespace ev = evaluation;
using inertial::Limb;

constexpr std::size_t kKeraalTargets = 17;
constexpr double kKeraalRate = 30.0;         // [Hz]
constexpr std::size_t kTargetsPerFrame = 2;  // the targets are sampled twice as often

struct KeraalRow {
  Limb limb;
  std::size_t target;
};
// clang-format off
constexpr std::array<KeraalRow, 13> kKeraal{{
  {Limb::Pelvis, 13}, {Limb::Chest, 4}, {Limb::UpperArmLeft, 3}, {Limb::UpperArmRight, 2}, {Limb::ForearmLeft, 1},
  {Limb::ForearmRight, 0}, {Limb::HandLeft, 10}, {Limb::HandRight, 9}, {Limb::ThighLeft, 6}, {Limb::ThighRight, 5},
  {Limb::ShankLeft, 16}, {Limb::ShankRight, 15}, {Limb::Head, 14}}};
// Joints that lie near a target, for the spaces' alignment.
constexpr std::array<std::pair<JointId, std::size_t>, 8> kNearTargets{{
  {JointId::SpineBase, 13}, {JointId::SpineShoulder, 4}, {JointId::ShoulderLeft, 8}, {JointId::ShoulderRight, 7},
  {JointId::Head, 14}, {JointId::HandLeft, 10}, {JointId::HandRight, 9}, {JointId::AnkleLeft, 12}}};
// clang-format on

struct TargetPose {
  Eigen::Vector3d place;
  Eigen::Quaterniond turned;
};

struct KeraalTake {
  std::vector<Skeleton<WorldSpace>> bodies;
  std::vector<std::vector<TargetPose>> targets;  ///< Of each of the bodies.
};

Result<std::vector<std::vector<double>>> lines_of_numbers(const std::filesystem::path& file) {
  const auto text = read_file(file, 64u << 20);
  if (!text) return pass(text);
  std::vector<std::vector<double>> out;
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::vector<double> numbers;
    for (std::string word; words >> word;) numbers.push_back(parse_finite(word).value_or(0.0));
    if (!numbers.empty()) out.push_back(std::move(numbers));
  }
  return out;
}

TargetPose pose_in(const std::vector<double>& row, std::size_t index, double metres) {
  const double* at = row.data() + 7 * index;
  return {metres * Eigen::Vector3d(at[0], at[1], at[2]),
          Eigen::Quaterniond(at[6], at[3], at[4], at[5])};
}

Result<KeraalTake> keraal_take(const std::filesystem::path& folder) {
  const auto kinect = lines_of_numbers(folder / "G3-Kinect-CTK-P1T1-Unknown-C-0.txt");
  const auto optical = lines_of_numbers(folder / "G3-Vicon-CTK-P1T1-Unknown-C-0.txt");
  if (!kinect) return pass(kinect);
  if (!optical) return pass(optical);
  KeraalTake take;
  for (std::size_t i = 0; i < kinect->size() && kTargetsPerFrame * i < optical->size(); ++i) {
    const auto& row = (*kinect)[i];
    const auto& beside = (*optical)[kTargetsPerFrame * i];
    if (row.size() < 7 * kJointCount || beside.size() < 7 * kKeraalTargets) continue;
    auto& body = take.bodies.emplace_back();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const TargetPose pose = pose_in(row, j, 1.0);
      body.joints[j].position = pose.place;
      body.joints[j].orientation = pose.turned;
      body.joints[j].state = JointState::Tracked;
    }
    auto& targets = take.targets.emplace_back();
    for (std::size_t t = 0; t < kKeraalTargets; ++t) targets.push_back(pose_in(beside, t, 1e-3));
  }
  return take;
}

/// The targets' space turned into the Kinect's, whose camera may look down: by places, so that only
/// a heading is left for the calibration.
Result<Eigen::Quaterniond> kinect_from_optical(const KeraalTake& take) {
  std::vector<Eigen::Vector3d> from, to;
  for (std::size_t i = 0; i < take.bodies.size(); ++i)
    for (const auto& [joint, target] : kNearTargets) {
      from.push_back(take.targets[i][target].place);
      to.push_back(take.bodies[i][joint].position);
    }
  const auto fit = fit_rigid(from, to);
  if (!fit) return pass(fit);
  return Eigen::Quaterniond(fit->target_from_source.linear());
}

void judge_limb(Report& report, const KeraalTake& take, const KeraalRow& row,
                const Eigen::Quaterniond& turned) {
  ev::OrientationPairs pairs;
  for (std::size_t i = 0; i < take.bodies.size(); ++i) {
    const auto tracked = ev::limb_from_orientation(take.bodies[i], row.limb);
    const Eigen::Quaterniond& target = take.targets[i][row.target].turned;
    if (tracked && is_unit(target))
      pairs.push_back({static_cast<double>(i) / kKeraalRate, *tracked, turned * target});
  }
  const std::string name = "keraal-" + std::string(name_of(row.limb));
  const auto fit = ev::fit_calibration(pairs);
  if (!fit) return report.note(name + ": not calibrated; " + to_string(fit.error()) + ".");
  std::vector<double> angles, swings, twists;
  double beyond = 0.0;
  for (const auto& each : ev::error_track(fit->calibration, pairs)) {
    angles.push_back(to_deg(each.value.angle));
    swings.push_back(to_deg(each.value.swing));
    twists.push_back(to_deg(std::abs(each.value.twist)));
    beyond += each.value.angle > ev::kPaperTau ? 1.0 : 0.0;
  }
  report.row(name, "angle_median_deg", percentile(angles, 0.5), "deg");
  report.row(name, "angle_p90_deg", percentile(angles, 0.9), "deg");
  report.row(name, "swing_p90_deg", percentile(swings, 0.9), "deg");
  report.row(name, "twist_p90_deg", percentile(twists, 0.9), "deg");
  report.row(name, "above_tau_percent", 100.0 * beyond / static_cast<double>(angles.size()), "%");
}

}  // namespace

Result<void> run_keraal(Report& report) {
  const auto folder = shared_recordings() / "keraal_kinect2_optical";
  std::error_code absent;
  if (!std::filesystem::exists(folder, absent)) {
    report.note("keraal: not measured; " + folder.string() + " is not there.");
    return {};
  }
  const auto take = keraal_take(folder);
  if (!take) return pass(take);
  const auto turned = kinect_from_optical(*take);
  if (!turned) return pass(turned);
  for (const KeraalRow& row : kKeraal) judge_limb(report, *take, row, *turned);
  report.note(
      "keraal: one take of 6.5 s; orientations that the Kinect states of its joints, against "
      "optical targets on the "
      "limbs, calibrated on the same take; gravity from a rigid fit of joints to targets.");
  return {};
}

}  // namespace chorus::bench
