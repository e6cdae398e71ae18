#include "fusion-server/facing/lateral.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::facing {
namespace {

constexpr double kGuessedPair = 0.3;  // Weight of a pair with an inferred joint.
// [m]; longer spans count as this long: a kick must not outweigh shoulders and hips.
constexpr double kMaxSpan = 0.7;
constexpr std::size_t kTrunkPairs = 2;
constexpr int kRounds = 3;  // Rounds of join(); one or two usually suffice.

struct Joined {
  Spans spans;          ///< Mean of the views, each with the sign that makes it agree.
  double agreed = 0.0;  ///< Sum of |agreement()| of the views with the mean [m^2].
};

Joined join(const std::vector<Spans>& views, const Spans& start) {
  Joined joined{start, 0.0};
  for (int round = 0; round < kRounds; ++round) {
    Spans sum = no_spans();
    joined.agreed = 0.0;
    for (const Spans& view : views) {
      const double found = agreement(view, joined.spans);
      joined.agreed += std::abs(found);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += (found < 0 ? -1.0 : 1.0) * view[i];
    }
    for (Eigen::Vector3d& span : sum) span /= static_cast<double>(views.size());
    joined.spans = sum;
  }
  return joined;
}

Eigen::Vector3d sum_of_trunk(const Spans& spans) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < kTrunkPairs; ++i) sum += spans[i];
  return sum;
}

}  // namespace

Spans no_spans() {
  Spans spans;
  spans.fill(Eigen::Vector3d::Zero());
  return spans;
}

Spans spans_of(const Skeleton<WorldSpace>& body) {
  Spans spans = no_spans();
  for (std::size_t i = 0; i < kSidePairs.size(); ++i) {
    const Joint& left = body[kSidePairs[i]];
    const Joint& right = body[mirror(kSidePairs[i])];
    if (!left.seen() || !right.seen()) continue;
    const bool tracked = left.state == JointState::Tracked && right.state == JointState::Tracked;
    const Eigen::Vector3d apart = left.position - right.position;
    spans[i] = (tracked ? 1.0 : kGuessedPair) * std::min(1.0, kMaxSpan / apart.norm()) * apart;
  }
  return spans;
}

double size_of(const Spans& spans) { return std::sqrt(agreement(spans, spans)); }

double agreement(const Spans& a, const Spans& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

void exchange_sides(Skeleton<WorldSpace>& body) {
  for (const auto& [left, right] : kMirrorPairs) std::swap(body[left], body[right]);
  for (Joint& joint : body.joints) joint.orientation.coeffs().setZero();
}

Eigen::Vector3d left_of(const Spans& spans) {
  const Eigen::Vector3d left = sum_of_trunk(spans);
  if (left.norm() < kMinSpan) return Eigen::Vector3d::Zero();
  return left.normalized();
}

Eigen::Vector3d forward_of(const Spans& spans) {
  Eigen::Vector3d left = sum_of_trunk(spans);
  left.y() = 0;
  if (left.norm() < kMinSpan) return Eigen::Vector3d::Zero();
  return left.normalized().cross(Eigen::Vector3d::UnitY());
}

std::optional<double> facing_of(const SensorView& view, const Eigen::Vector3d& forward) {
  const Joint& neck = view.skeleton[JointId::Neck];
  const Joint& base = view.skeleton[JointId::SpineBase];
  const Joint& stands = neck.seen() ? neck : base;
  if (!stands.seen() || forward.isZero()) return std::nullopt;
  const Eigen::Vector3d to_sensor = view.eye - stands.position;
  return wrap_angle(std::atan2(forward.x(), forward.z()) -
                    std::atan2(to_sensor.x(), to_sensor.z()));
}

Spans agreed_spans(const std::vector<Spans>& views) {
  Joined best{no_spans(), -1.0};
  for (const Spans& start : views) {
    const Joined found = join(views, start);
    if (found.agreed > best.agreed) best = found;
  }
  return best.spans;
}

}  // namespace chorus::facing
