// Fused bodies of simulated days: what the report says of their noise, beside the truth.
#include <algorithm>
#include <cmath>
#include <deque>

#include <fmt/format.h>

#include "common/body/bones.h"
#include "common/quality/joint_judge.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/bench/quality/report_cases.h"
#include "tests/bench/quality/simulated_day.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr double kSlow = 0.1;         // [m/s], as in the report
constexpr std::size_t kFewest = 200;  // instants of a figure that is compared
constexpr std::array kBinomials{1.0, 2.0, 6.0, 20.0, 70.0, 252.0};  // sums of squares

/// Differences of this order of the last places.
Eigen::Vector3d difference(const std::deque<Eigen::Vector3d>& places, std::size_t order) {
  std::vector<Eigen::Vector3d> last(places.end() - static_cast<std::ptrdiff_t>(order) - 1,
                                    places.end());
  for (std::size_t k = 0; k < order; ++k)
    for (std::size_t i = 0; i + 1 < last.size() - k; ++i) last[i] = last[i + 1] - last[i];
  return last.front();
}

/// Noise of the error of one joint, at rest and in motion by the truth.
struct TrueJitter {
  std::deque<Eigen::Vector3d> errors;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  double rest = 0.0;
  std::size_t rests = 0;
  double motion = 0.0;
  std::size_t motions = 0;

  void add(const Eigen::Vector3d& found, const Eigen::Vector3d& exact, double step) {
    const double speed = (exact - before).norm() / step;
    before = exact;
    errors.push_back(found - exact);
    if (errors.size() > kBinomials.size()) errors.pop_front();
    const bool slow = speed < kSlow;
    const std::size_t order = slow ? quality::kRestOrder : quality::kMotionOrder;
    if (errors.size() <= order) return;
    (slow ? rest : motion) += difference(errors, order).squaredNorm() / 3.0 / kBinomials[order];
    ++(slow ? rests : motions);
  }
};

struct Ratios {
  std::vector<double> rest, motion, bones;
  double found = 0.0;
  double exact = 0.0;
  double stated_by_truth = 0.0;  ///< True error / stated one.
  double stated_by_views = 0.0;
};

struct TrueNoise {
  std::array<TrueJitter, kJointCount> jitter;
  std::array<std::vector<double>, kBones.size()> lengths;
  double squares = 0.0;
  double stated = 0.0;

  void add(const resource::BodyResource& body, const Skeleton<WorldSpace>& exact, double step);
};

void TrueNoise::add(const resource::BodyResource& body, const Skeleton<WorldSpace>& exact,
                    double step) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto& joint = body.joints[j];
    if (!joint.seen()) {
      jitter[j].errors.clear();
      continue;
    }
    jitter[j].add(joint.position, exact.joints[j].position, step);
    if (!(joint.variance.value_or(0.0) > 0.0) || joint.contributors == 0) continue;
    const double stated_variance =
        joint.covariance.known() ? joint.covariance.matrix().trace() / 3.0 : *joint.variance;
    squares += (joint.position - exact.joints[j].position).squaredNorm() / 3.0;
    stated += stated_variance;
  }
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const auto& parent = body.joints[index_of(kBones[b].parent)];
    const auto& child = body.joints[index_of(kBones[b].child)];
    if (!parent.seen() || !child.seen()) continue;
    const double length =
        (exact[kBones[b].parent].position - exact[kBones[b].child].position).norm();
    lengths[b].push_back((parent.position - child.position).norm() / length);
  }
}

double variation(const std::vector<double>& values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1)) / mean;
}

Result<Ratios> noise_of(const std::string& profile, std::uint64_t seed) {
  DaySetting setting;
  setting.work.profile = profile;
  setting.work.seed = seed;
  setting.work.length = std::chrono::seconds(60);
  const auto day = simulated_day(setting);
  if (!day) return pass(day);
  const quality::RecordingQuality found = judged(*day);
  TrueNoise exact;
  for (const auto& frame : day->fused)
    if (!frame.bodies.empty())
      exact.add(frame.bodies.front(), true_body(*day, 0, frame.captured), 1.0 / setting.rate_hz);
  Ratios out;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const TrueJitter& own = exact.jitter[j];
    const auto root = [](double sum, std::size_t n) {
      return std::sqrt(sum / static_cast<double>(n));
    };
    if (own.rests > kFewest)
      out.rest.push_back(found.fused.joints[j].jitter_at_rest / root(own.rest, own.rests));
    if (own.motions > kFewest)
      out.motion.push_back(found.fused.joints[j].jitter_in_motion / root(own.motion, own.motions));
  }
  if (found.fused.people.empty()) return fail(ErrorCode::NotFound, profile, "nobody was fused");
  for (std::size_t b = 0; b < kBones.size(); ++b)
    if (exact.lengths[b].size() > kFewest)
      out.bones.push_back(found.fused.people.front().bones[b].variation /
                          variation(exact.lengths[b]));
  out.stated_by_truth = std::sqrt(exact.squares / exact.stated);
  double views = 0.0;
  double stated = 0.0;
  for (const quality::ViewError& each : found.views) {
    if (!(each.stated > 0.0) || !std::isfinite(each.found)) continue;
    views += each.found * each.found;
    stated += each.stated * each.stated;
  }
  out.stated_by_views = std::sqrt(views / stated);
  return out;
}

void report_ratios(Report& report, const std::string& name, std::vector<double> ratios) {
  if (ratios.empty()) return;
  std::ranges::sort(ratios);
  const auto at = [&](double share) {
    return ratios[std::min(ratios.size() - 1,
                           static_cast<std::size_t>(share * static_cast<double>(ratios.size())))];
  };
  Row row{"noise", name, at(0.5), "of the truth", ""};
  row.spread = Spread{at(0.5), at(0.05), at(0.95), 0, ratios.size()};
  report.row(row);
  const bool holds = std::abs(at(0.5) - 1.0) <= 0.1;
  report.condition(
      fmt::format("noise: {} is within 10 % of the truth in the median (is {:.2f})", name, at(0.5)),
      holds);
}

}  // namespace

Result<void> report_noise(Report& report) {
  const std::size_t draws = report.quick() ? 1 : 4;
  for (const std::string profile : {"gauss", "A", "B", "D"}) {
    const auto all = over_draws(
        draws, [&](std::size_t draw) { return noise_of(profile, report.seed() + draw); });
    Ratios pooled;
    std::vector<double> stated;
    for (const auto& each : all) {
      if (!each) return pass(each);
      pooled.rest.insert(pooled.rest.end(), each->rest.begin(), each->rest.end());
      pooled.motion.insert(pooled.motion.end(), each->motion.begin(), each->motion.end());
      pooled.bones.insert(pooled.bones.end(), each->bones.begin(), each->bones.end());
      stated.push_back(each->stated_by_views / each->stated_by_truth);
      report.row("noise-" + profile, "true_over_stated", each->stated_by_truth, "", "by-views",
                 each->stated_by_truth / each->stated_by_views);
    }
    report_ratios(report, "jitter_at_rest-" + profile, pooled.rest);
    report_ratios(report, "jitter_in_motion-" + profile, pooled.motion);
    report_ratios(report, "bone_variation-" + profile, pooled.bones);
    report_ratios(report, "stated_error-" + profile, stated);
  }
  return {};
}

}  // namespace chorus::bench
