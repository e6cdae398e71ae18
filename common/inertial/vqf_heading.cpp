// The heading of VQF: which fields are believed, and how fast.
#include <algorithm>
#include <cmath>

#include "common/geometry/rotation.h"
#include "common/inertial/vqf_parts.h"

namespace chorus::inertial {
namespace {

// Values of the paper's Table 2.
constexpr double kFieldTau = 0.05;
constexpr double kReferenceTau = 20.0;
constexpr double kFieldNormTolerance = 0.1;
constexpr double kDipTolerance = deg(10.0);
constexpr double kNewTime = 20.0;
constexpr double kNewFirstTime = 5.0;
constexpr double kNewMinRate = deg(20.0);
constexpr double kMinUndisturbedTime = 0.5;
constexpr double kMaxRejectionTime = 60.0;
constexpr double kRejectionFactor = 2.0;

bool alike(const Eigen::Vector2d& a, const Eigen::Vector2d& reference) {
  return std::abs(a(0) - reference(0)) < kFieldNormTolerance * reference(0) &&
         std::abs(a(1) - reference(1)) < kDipTolerance;
}

}  // namespace

double asked_by(const Eigen::Vector3d& level) { return std::atan2(level.x(), level.y()); }

FieldReference::FieldReference(double period)
    : period_(period),
      gain_(first_order_gain(kReferenceTau, period)),
      current_(low_pass_gains(kFieldTau, period)) {}

void FieldReference::update(const Eigen::Vector3d& level, double rate) {
  const double norm = level.norm();
  now_ = current_({norm, -std::asin(std::clamp(level.z() / norm, -1.0, 1.0))});
  if (alike(now_, reference_)) {
    undisturbed_time_ += period_;
    if (undisturbed_time_ >= kMinUndisturbedTime) {
      disturbed_ = false;
      reference_ += gain_ * (now_ - reference_);
    }
  } else {
    undisturbed_time_ = 0.0;
    disturbed_ = true;
  }
  renew(rate);
}

/// A field that stays the same for long while the sensor turns is the new reference.
void FieldReference::renew(double rate) {
  if (!alike(now_, candidate_)) {
    candidate_time_ = 0.0;
    candidate_ = now_;
    return;
  }
  if (rate >= kNewMinRate) candidate_time_ += period_;
  candidate_ += gain_ * (now_ - candidate_);
  const double wanted = reference_(0) > 0.0 ? kNewTime : kNewFirstTime;
  if (!disturbed_ || candidate_time_ < wanted) return;
  reference_ = candidate_;
  disturbed_ = false;
  undisturbed_time_ = kMinUndisturbedTime;
}

VqfDelta::VqfDelta(double period, const VqfOptions& options)
    : period_(period),
      gain_(first_order_gain(options.tau_field, period)),
      tau_(options.tau_field),
      rejected_time_(kMaxRejectionTime),
      rejects_(options.rejects_disturbed_fields) {}

/// A disturbed field counts for nothing at first, and after a minute half: it may be all there is.
double VqfDelta::gain_for(bool disturbed) {
  double gain = gain_;
  if (rejects_ && disturbed) {
    const bool waits = rejected_time_ <= kMaxRejectionTime;
    if (waits) rejected_time_ += period_;
    gain = waits ? 0.0 : gain / kRejectionFactor;
  } else {
    rejected_time_ = std::max(rejected_time_ - kRejectionFactor * period_, 0.0);
  }
  if (starting_gain_ <= 0.0) return gain;
  // At the start the offset is the mean of all that was said.
  gain = std::max(gain, starting_gain_);
  starting_gain_ /= starting_gain_ + 1.0;
  if (starting_gain_ * tau_ < period_) starting_gain_ = 0.0;
  return gain;
}

void VqfDelta::update(double said, bool disturbed) {
  const double off = wrap_angle(said - delta_);
  if (std::isfinite(off)) delta_ = wrap_angle(delta_ + gain_for(disturbed) * off);
}

void VqfHeading::update(const Eigen::Vector3d& level, double rate) {
  if (rejects_) reference_.update(level, rate);
  offset_.update(asked_by(level), disturbed());
}

}  // namespace chorus::inertial
