#include "fusion-server/fusion/sighted_body.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "fusion-server/fusion/least_squares.h"

namespace chorus::fusion {
namespace {

constexpr int kRounds = 3;
constexpr int kFirstWeighings = 5;  // re-weightings of a joint's views, starting from their mean
// A turn of a view that may be due to noise alone.
constexpr double kSlightTurn = deg(5);
constexpr int kWeighings = 2;  // re-weightings that start from the body held by its bones

Eigen::Matrix3d round_covariance(double variance) { return variance * Eigen::Matrix3d::Identity(); }

/// Variance of the pose error that goes into the weights [m^2].
double weighed_pose(const FusionConfig& config, JointId joint, JointState state) {
  const double tracked = pose_variance(config.pose_error, joint, JointState::Tracked);
  const BodyModel& body = config.body;
  const double factor = body.pose * (state == JointState::Inferred ? body.inferred : 1.0);
  return factor * factor * tracked;
}

bool has_points(const SeenBody& seen) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (seen.has(j)) return true;
  }
  return false;
}

}  // namespace

SightedBody::SightedBody(const Person& person, const Instant& instant, const ErrorModel& errors,
                         const FusionConfig& config, const Biases& biases)
    : config_(config), person_(person), seen_(person.views.size()), misfits_(person.views.size()) {
  for (Sights& sights : sights_) {
    sights.views.reserve(person.views.size());
    sights.weighings.reserve(person.views.size());
  }
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    const SensorId& sensor = person.views[v].sensor;
    const auto bias = biases.find(sensor);
    seen_[v].eye = person.views[v].eye;
    take(v, contributor_of(sensor, instant.sensors), errors,
         bias == biases.end() ? nullptr : &bias->second);
  }
}

void SightedBody::take(std::size_t v, std::uint64_t contributor, const ErrorModel& errors,
                       const Offsets* biases) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto joint = static_cast<JointId>(j);
    auto view = point_or_ray_of(person_.views[v], joint, contributor, errors);
    if (!view) continue;
    view->view = v;
    Sights& sights = sights_[j];
    if (view->joint.covariance.known() || view->joint.bears()) sights.round = false;
    sights.weighings.push_back(weighed(*view, joint, biases));
    if (view->joint.seen()) {
      view->joint.position -= sights.weighings.back().bias;
      seen_[v].place[j] = view->joint.position;
      seen_[v].information[j] = view->covariance.inverse();
    }
    sights.views.push_back(*std::move(view));
  }
}

/// The view's weighing.  Also adds to the view's covariance the pose error that goes into the
/// weights.
SightedBody::Weighing SightedBody::weighed(JointView& view, JointId joint,
                                           const Offsets* biases) const {
  Weighing weighing;
  weighing.stated = mean_variance(view.covariance);
  if (view.joint.seen() && !view.whole) {
    weighing.stated += pose_variance(config_.pose_error, joint, view.joint.state);
    view.covariance += round_covariance(weighed_pose(config_, joint, view.joint.state));
  }
  weighing.variance = mean_variance(view.covariance);
  if (view.joint.seen() && biases != nullptr) weighing.bias = (*biases)[index_of(joint)];
  return weighing;
}

void SightedBody::settle(const HeldBones& bones, const PlacedBody& expected,
                         const BodyModel& model) {
  place_all(expected, nullptr);
  for (int round = 0; round < kRounds; ++round) {
    const PlacedBody held = hold_bones(placed_, bones, 1);
    mend(held, model);
    place_all(expected, &held);
  }
  turn_sigma_ = common_turn(misfits_, model);
}

void SightedBody::place_all(const PlacedBody& expected, const PlacedBody* start) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Sights& sights = sights_[j];
    if (sights.views.empty()) continue;
    placed_[j] = sights.round ? robust_mean(sights, start == nullptr ? nullptr : &(*start)[j])
                              : robust_squares(sights, expected[j]);
  }
}

bool SightedBody::determined(std::size_t joint) const {
  return placed_[joint].placed && !sights_[joint].bounded;
}

/// Eq. (3), solved by re-weighting.
PlacedJoint SightedBody::robust_mean(Sights& sights, const PlacedJoint* start) const {
  const double huber = config_.body.huber;
  PlacedJoint joint = start != nullptr ? *start : PlacedJoint{};
  const int weighings = start != nullptr ? kWeighings : kFirstWeighings;
  for (int i = 0; i < weighings; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double information = 0.0;
    for (std::size_t v = 0; v < sights.views.size(); ++v) {
      Weighing& weighing = sights.weighings[v];
      const Eigen::Vector3d& place = sights.views[v].joint.position;
      // The bias was subtracted but counts as distance, so that a view known to be biased is
      // trusted less.
      const Eigen::Vector3d off = place + weighing.bias - joint.position;
      const double distance = off.norm() / std::sqrt(weighing.variance);
      const bool weigh = joint.placed && huber > 0 && distance > huber;
      weighing.trust = weigh ? huber / distance : 1.0;
      weighing.pull = weighing.trust / weighing.variance;
      sum += weighing.pull * place;
      information += weighing.pull;
    }
    joint = {sum / information, round_covariance(1.0 / information), true};
  }
  return joint;
}

PlacedJoint SightedBody::robust_squares(Sights& sights, const PlacedJoint& expected) const {
  auto found = least_squares(sights.views, config_.huber);
  // A point is placed whatever its covariance is; a joint with rays alone only if they determine
  // it.
  const bool point =
      std::ranges::any_of(sights.views, [](const JointView& view) { return view.joint.seen(); });
  const auto is_open = [&](const auto& solved) {
    return !solved || (!point && largest_sigma(solved->covariance) > config_.max_sigma);
  };
  const bool open = is_open(found);
  sights.bounded = open;
  if (open && expected.placed) {
    std::vector<JointView> views = sights.views;
    views.emplace_back().joint.position = expected.position;
    views.back().joint.state = JointState::Inferred;
    views.back().covariance = expected.covariance;
    found = least_squares(views, config_.huber);
  }
  if (is_open(found)) {
    for (Weighing& weighing : sights.weighings) weighing.trust = 0.0;  // its place is not from them
    return {};
  }
  for (std::size_t v = 0; v < sights.views.size(); ++v) {
    sights.weighings[v].trust = found->trust[v];
    sights.weighings[v].pull = found->pull[v];
  }
  return {found->position, found->covariance, true};
}

void SightedBody::mend(const PlacedBody& body, const BodyModel& model) {
  if (!(model.scale > 0) && !(model.turn > 0)) return;
  for (std::size_t v = 0; v < seen_.size(); ++v) {
    misfits_[v] = misfit_of(seen_[v], body, misfits_[v], model);
  }
  std::vector<Offsets> places;
  places.reserve(seen_.size());
  for (std::size_t v = 0; v < seen_.size(); ++v)
    places.push_back(mended(seen_[v], body, misfits_[v]));
  for (std::size_t j = 0; j < kJointCount; ++j) {
    for (JointView& view : sights_[j].views) {
      if (view.joint.seen()) view.joint.position = places[view.view][j];
    }
    if (sights_[j].round) doubt(sights_[j], model);
  }
}

/// Adds to the variances of turned views, in place of what was added in the previous round.
void SightedBody::doubt(Sights& sights, const BodyModel& model) const {
  for (std::size_t v = 0; v < sights.views.size(); ++v) {
    const double turn = std::abs(misfits_[sights.views[v].view].turn);
    const double sigma = model.turn_doubt * std::max(0.0, turn - kSlightTurn);
    Weighing& weighing = sights.weighings[v];
    const double more = sigma * sigma - weighing.doubt;
    weighing.variance += more;
    weighing.stated += more;
    weighing.doubt += more;
  }
}

void SightedBody::learn(Biases& biases, const PlacedBody& body, double passed,
                        double turned) const {
  const BodyModel& model = config_.body;
  const double kept = std::exp(-passed / seconds(model.bias_memory) - turned / model.bias_turn);
  const double share = std::min(1.0, passed * model.bias_rate);
  for (auto& [sensor, bias] : biases) {
    for (Eigen::Vector3d& each : bias) each *= kept;
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!determined(j)) continue;
    for (const JointView& view : sights_[j].views) {
      if (!view.joint.seen()) continue;
      const auto [bias, fresh] = biases.try_emplace(person_.views[view.view].sensor);
      if (fresh) bias->second.fill(Eigen::Vector3d::Zero());
      bias->second[j] += share * (view.joint.position - body[j].position);
    }
  }
}

std::vector<ViewPulls> SightedBody::pulls() const {
  std::vector<ViewPulls> all;
  for (const SensorView& view : person_.views) all.push_back({view.sensor, {}});
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!determined(j)) continue;
    for (std::size_t v = 0; v < sights_[j].views.size(); ++v) {
      const JointView& view = sights_[j].views[v];
      const Weighing& weighing = sights_[j].weighings[v];
      if (!view.joint.seen()) continue;
      all[view.view].joints[j] = {weighing.trust / weighing.variance, view.joint.state,
                                  view.joint.position - placed_[j].position};
    }
  }
  return all;
}

Eigen::Matrix3d SightedBody::stated(std::size_t joint) const {
  const Sights& sights = sights_[joint];
  if (!sights.round) return placed_[joint].covariance;
  double information = 0.0;
  for (std::size_t v = 0; v < sights.views.size(); ++v) {
    information += sights.weighings[v].trust / sights.weighings[v].stated;
  }
  return round_covariance(1.0 / information);
}

StatedVariances SightedBody::stated_variances() const {
  StatedVariances all{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (determined(j) && sights_[j].round) all[j] = mean_variance(stated(j));
  }
  return all;
}

std::size_t SightedBody::plain_views(std::size_t joint) const {
  return sights_[joint].round ? sights_[joint].views.size() : 0;
}

ShownDifferences SightedBody::disagreement() const {
  constexpr double kDimensions = 3.0;
  ShownDifferences shown;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Sights& sights = sights_[j];
    if (!determined(j) || plain_views(j) < 2) continue;
    for (std::size_t v = 0; v < sights.views.size(); ++v) {
      const Weighing& weighing = sights.weighings[v];
      const Eigen::Vector3d off =
          sights.views[v].joint.position + weighing.bias - placed_[j].position;
      shown[j].sum += weighing.trust * off.squaredNorm() / (kDimensions * weighing.stated);
    }
    shown[j].free = static_cast<double>(sights.views.size() - 1);
  }
  return shown;
}

std::optional<double> SightedBody::scale_square() const {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t v = 0; v < seen_.size(); ++v) {
    // Rays alone have no size.
    if (!has_points(seen_[v])) continue;
    sum += misfits_[v].scale * misfits_[v].scale;
    count += 1.0;
  }
  if (count < 2.0) return std::nullopt;
  return sum / count;
}

FusedJoint SightedBody::shown(JointId joint) const {
  const Sights& sights = sights_[index_of(joint)];
  FusedJoint fused;
  fused.joint.state = JointState::Inferred;
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<double> weights;
  ShareTally tally;
  for (std::size_t v = 0; v < sights.views.size(); ++v) {
    const Weighing& weighing = sights.weighings[v];
    if (weighing.trust == 0.0) continue;
    const JointView& view = sights.views[v];
    fused.joint.state = std::max(fused.joint.state, view.joint.state);
    fused.contributors |= view.contributor;
    tally.add(view.contributor, weighing.pull);
    if (!is_unit(view.joint.orientation)) continue;
    rotations.push_back(about_y(-misfits_[view.view].turn) * view.joint.orientation);
    weights.push_back(weighing.trust / weighing.variance);
  }
  fused.shares = tally.shares();
  if (!rotations.empty()) fused.joint.orientation = weighted_lerp(rotations, weights);
  return fused;
}

}  // namespace chorus::fusion
