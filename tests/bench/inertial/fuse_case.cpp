// What inertial sensors help fusion: limbs that no camera shows, limbs that all show, a sensor that
// slips.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/LU>

#include "common/base/units.h"
#include "tests/bench/inertial/inertial_cases.h"
#include "tests/bench/inertial/worn_takes.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using enum JointId;
using inertial::Limb;

constexpr std::array kSeenJoints{ShoulderLeft, ShoulderRight, ElbowLeft, ElbowRight,
                                 WristLeft,    WristRight,    HipLeft,   HipRight,
                                 KneeLeft,     KneeRight,     AnkleLeft, AnkleRight};

/// What is hidden, and which of it is judged.
struct HiddenLimbs {
  const char* name;
  std::vector<JointId> judged;
  std::vector<JointId> also;  ///< Ends of the limbs, hidden with them.
};

constexpr std::size_t kHideEvery = 75;  // instants
constexpr std::size_t kHideFor = 30;    // a second
constexpr std::size_t kBackFor = 6;     // instants in which a limb comes back
constexpr double kLeapLimit = 0.04;     // [m]

bool in_window(std::size_t from, std::size_t index, std::size_t length) {
  return index >= from && (index - from) % kHideEvery < length;
}

struct FusedErrors {
  std::vector<double> all;      ///< [m]
  std::vector<double> leaps;    ///< Steps of the error when limbs are seen again [m],
  std::vector<double> first;    ///< and those of the first instant alone: of handing back.
  std::vector<double> squared;  ///< Squared error by stated variance, per axis.
  double asked = 0.0;
};

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? kNoRatio : sum / static_cast<double>(values.size());
}

void judge_joint(const FusedTake& fused, const WornTake& take, std::size_t i, JointId id,
                 FusedErrors& out) {
  out.asked += 1.0;
  if (!fused.bodies[i] || !fused.bodies[i]->skeleton[id].seen()) return;
  const Joint& joint = fused.bodies[i]->skeleton[id];
  const Eigen::Vector3d off = joint.position - take.rays.truth[i].skeleton[id].position;
  out.all.push_back(off.norm());
  if (!joint.covariance.known()) return;
  const Eigen::Vector3d by = joint.covariance.matrix().inverse() * off;
  out.squared.push_back(off.dot(by) / 3.0);
}

/// How far the joint's error steps from the instant before to this one.
void judge_leap(const FusedTake& fused, const WornTake& take, std::size_t i, JointId id, bool first,
                FusedErrors& out) {
  const auto off = [&](std::size_t at) -> std::optional<Eigen::Vector3d> {
    if (!fused.bodies[at] || !fused.bodies[at]->skeleton[id].seen()) return std::nullopt;
    return fused.bodies[at]->skeleton[id].position - take.rays.truth[at].skeleton[id].position;
  };
  const auto before = off(i - 1);
  const auto now = off(i);
  if (!before || !now) return;
  out.leaps.push_back((*now - *before).norm());
  if (first) out.first.push_back(out.leaps.back());
}

FusedErrors hidden_errors(const FusedTake& fused, const WornTake& take,
                          const std::vector<JointId>& joints) {
  FusedErrors out;
  const std::size_t from = take.judged_from();
  for (std::size_t i = from; i < take.size(); ++i) {
    for (const JointId id : joints) {
      if (in_window(from, i, kHideFor)) judge_joint(fused, take, i, id, out);
      const bool back = !in_window(from, i, kHideFor) && in_window(from, i, kHideFor + kBackFor);
      if (back) judge_leap(fused, take, i, id, in_window(from, i - 1, kHideFor), out);
    }
  }
  return out;
}

FusedErrors seen_errors(const FusedTake& fused, const WornTake& take, std::size_t from) {
  FusedErrors out;
  for (std::size_t i = from; i < take.size(); ++i)
    for (const JointId id : kSeenJoints) judge_joint(fused, take, i, id, out);
  return out;
}

void add_errors(FusedErrors& to, const FusedErrors& more) {
  to.all.insert(to.all.end(), more.all.begin(), more.all.end());
  to.leaps.insert(to.leaps.end(), more.leaps.begin(), more.leaps.end());
  to.squared.insert(to.squared.end(), more.squared.begin(), more.squared.end());
  to.asked += more.asked;
}

double missing_percent(const FusedErrors& errors) {
  return 100.0 * (1.0 - static_cast<double>(errors.all.size()) / std::max(1.0, errors.asked));
}

Result<void> hide(Report& report, const WornTake& take, const HiddenLimbs& limbs) {
  const std::size_t from = take.judged_from();
  const Hides hides = [&](JointId id, std::size_t i) {
    const auto among = [&](const auto& ids) { return std::ranges::find(ids, id) != ids.end(); };
    return in_window(from, i, kHideFor) && (among(limbs.judged) || among(limbs.also));
  };
  const auto seen = seen_by(take, {0, 2, 4, 6}, hides);
  if (!seen) return pass(seen);
  const SensorFaults faults;
  const FusedErrors ours = hidden_errors(fused_with(take, *seen, &faults), take, limbs.judged);
  const FusedErrors filter = hidden_errors(fused_by_body_filter(*seen), take, limbs.judged);
  const auto unhidden = seen_by(take, {0, 2, 4, 6});
  if (!unhidden) return pass(unhidden);
  const FusedErrors usual = hidden_errors(fused_with(take, *unhidden, nullptr), take, limbs.judged);
  const FusedErrors shipped = hidden_errors(fused_with(take, *seen, nullptr), take, limbs.judged);
  const std::string name = fmt::format("fuse-hidden-{}-{}", take.name, limbs.name);
  const double error = mean_of(ours.all);
  const double beside = mean_of(filter.all);
  report.row(name, "mpjpe_mm", to_mm(error), "mm", "body-filter", error / beside);
  report.row(name, "body_filter_mm", to_mm(beside), "mm");
  report.row(name, "missing_percent", missing_percent(ours), "%");
  report.row(name, "body_filter_missing_percent", missing_percent(filter), "%");
  report.row(name, "shipped_missing_percent", missing_percent(shipped), "%");
  report.row(name, "leap_p99_mm", to_mm(percentile(ours.leaps, 0.99)), "mm", "body-filter",
             percentile(ours.leaps, 0.99) / percentile(filter.leaps, 0.99));
  report.row(name, "leap_first_p99_mm", to_mm(percentile(ours.first, 0.99)), "mm", "unhidden",
             percentile(ours.first, 0.99) / percentile(usual.first, 0.99));
  // The same instants of a take in which nothing is hidden: cameras err by leaps, too.
  report.row(name, "leap_unhidden_p99_mm", to_mm(percentile(usual.leaps, 0.99)), "mm");
  report.row(name, "leap_median_mm", to_mm(median(ours.leaps)), "mm", "unhidden",
             median(ours.leaps) / median(usual.leaps));
  report.row(name, "nees", mean_of(ours.squared), "1");
  report.condition(name + ": at most half of the body filter's error",
                   error <= 0.5 * beside && ours.all.size() >= filter.all.size());
  report.condition(name + ": at most 100 mm", error <= 0.1);
  report.condition(name + ": seen again without a leap of 40 mm",
                   percentile(ours.leaps, 0.99) <= kLeapLimit);
  return {};
}

struct CameraChoice {
  const char* name;
  std::vector<std::vector<std::size_t>> cameras;
  double target;      ///< Of cameras alone.
  double p95_target;  ///< The same.
};

Result<void> watch_seen(Report& report, const std::vector<WornTake>& takes,
                        const CameraChoice& choice) {
  FusedErrors ours, alone;
  for (const WornTake& take : takes) {
    FusedErrors own, own_alone;
    for (const auto& cameras : choice.cameras) {
      const auto seen = seen_by(take, cameras);
      if (!seen) return pass(seen);
      const SensorFaults faults;
      add_errors(own, seen_errors(fused_with(take, *seen, &faults), take, take.judged_from()));
      add_errors(own_alone,
                 seen_errors(fused_with(take, *seen, nullptr), take, take.judged_from()));
      if (report.quick()) break;
    }
    const std::string name = fmt::format("fuse-seen-{}-{}", choice.name, take.name);
    report.row(name, "mpjpe_mm", to_mm(mean_of(own.all)), "mm", "cameras alone",
               mean_of(own.all) / mean_of(own_alone.all));
    add_errors(ours, own);
    add_errors(alone, own_alone);
  }
  const std::string name = fmt::format("fuse-seen-{}", choice.name);
  const double ratio = mean_of(ours.all) / mean_of(alone.all);
  const double tail = percentile(ours.all, 0.95) / percentile(alone.all, 0.95);
  report.row(name, "mpjpe_mm", to_mm(mean_of(ours.all)), "mm", "cameras alone", ratio);
  report.row(name, "p95_mm", to_mm(percentile(ours.all, 0.95)), "mm", "cameras alone", tail);
  report.row(name, "nees", mean_of(ours.squared), "1", "cameras alone",
             mean_of(ours.squared) / mean_of(alone.squared));
  report.row(name, "nees_median", median(ours.squared), "1");
  report.row(name, "missing_percent", missing_percent(ours), "%");
  report.row(name, "missing_percent_alone", missing_percent(alone), "%");
  report.condition(fmt::format("{}: at most {} of cameras alone", name, choice.target),
                   ratio <= choice.target);
  report.condition(fmt::format("{}: p95 at most {} of cameras alone", name, choice.p95_target),
                   tail <= choice.p95_target);
  return {};
}

/// One sensor turns by 60 degrees on its limb at 60 % of the take.
Result<void> let_slip(Report& report, const WornTake& take) {
  const auto seen = seen_by(take, {0, 2, 4, 6});
  if (!seen) return pass(seen);
  const FusedTake fine = fused_with(take, *seen, std::make_unique<SensorFaults>().get());
  for (const Limb limb :
       {Limb::ForearmLeft, Limb::UpperArmRight, Limb::ShankLeft, Limb::ThighRight}) {
    SensorFaults faults;
    faults.slips = limb;
    faults.slips_at = 0.6 * static_cast<double>(take.size()) / kTakeHz;
    faults.slip = deg(60);
    std::optional<double> told;
    const FusedTake slipped =
        fused_with(take, *seen, &faults, [&](std::size_t i, const worn::Wear& wear) {
          const double time = static_cast<double>(i) / kTakeHz;
          const Timestamp at = importers::kDefaultStart + from_seconds(time);
          if (told || time < faults.slips_at) return;
          for (const WornReport& source : wear.reports(at))
            for (const WornSensorReport& one : source.sensors)
              if (one.limb == limb && one.slipped_ago &&
                  *one.slipped_ago < time - faults.slips_at + 0.01)
                told = time;
        });
    const std::string name = fmt::format("fuse-slip-{}-{}", take.name, name_of(limb));
    report.row(name, "told_after_s", told ? *told - faults.slips_at : kNoRatio, "s");
    report.condition(name + ": told within 5 s", told && *told - faults.slips_at <= 5.0);
    if (!told) continue;
    const auto from = static_cast<std::size_t>(*told * kTakeHz);
    const double cost =
        mean_of(seen_errors(slipped, take, from).all) / mean_of(seen_errors(fine, take, from).all);
    report.row(name, "cost_percent", 100.0 * (cost - 1.0), "%");
    report.condition(name + ": costs at most 1 % once told", cost <= 1.01);
    if (report.quick()) break;
  }
  return {};
}

constexpr const char* kNoWornTakes =
    "left out: needs the takes of eight real cameras with gt_skel_gbl_ori.txt "
    "(CHORUS_EIGHT_VIEWS, tests/bench/camera/totalcapture_views.py --orientations) and the 13 "
    "Xsens sensors (CHORUS_XSENS13)";

}  // namespace

Result<void> run_fuse_hidden(Report& report) {
  const auto takes = worn_takes();
  if (!takes) return pass(takes);
  if (takes->empty()) report.note(std::string("fuse-hidden: ") + kNoWornTakes);
  const std::array kinds{
      HiddenLimbs{"arms",
                  {ElbowLeft, ElbowRight, WristLeft, WristRight},
                  {HandLeft, HandRight, HandTipLeft, HandTipRight, ThumbLeft, ThumbRight}},
      HiddenLimbs{"legs", {KneeLeft, KneeRight, AnkleLeft, AnkleRight}, {FootLeft, FootRight}},
      HiddenLimbs{"wrists",
                  {WristLeft, WristRight},
                  {HandLeft, HandRight, HandTipLeft, HandTipRight, ThumbLeft, ThumbRight}}};
  for (const WornTake& take : *takes) {
    for (const HiddenLimbs& limbs : kinds) {
      if (auto ok = hide(report, take, limbs); !ok) return ok;
      if (report.quick()) return {};
    }
  }
  return {};
}

Result<void> run_fuse_seen(Report& report) {
  const auto takes = worn_takes();
  if (!takes) return pass(takes);
  if (takes->empty()) {
    report.note(std::string("fuse-seen: ") + kNoWornTakes);
    return {};
  }
  const std::array choices{CameraChoice{"two", {{0, 2}, {1, 3}, {4, 6}}, 0.92, 0.85},
                           CameraChoice{"four", {{0, 2, 4, 6}, {1, 3, 5, 7}}, 1.01, 1.01},
                           CameraChoice{"eight", {{0, 1, 2, 3, 4, 5, 6, 7}}, 1.01, 1.01}};
  for (const CameraChoice& choice : choices) {
    if (auto ok = watch_seen(report, *takes, choice); !ok) return ok;
    if (report.quick()) return {};
  }
  for (const WornTake& take : *takes) {
    if (auto ok = let_slip(report, take); !ok) return ok;
  }
  return {};
}

}  // namespace chorus::bench
