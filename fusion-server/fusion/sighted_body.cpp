#include "fusion-server/fusion/sighted_body.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/rotation.h"
#include "fusion-server/fusion/least_squares.h"

namespace chorus::fusion {
namespace {

constexpr int kRounds = 3;
constexpr int kFirstWeighings = 5;  // re-weightings of a joint's views, starting from their mean
constexpr int kWeighings = 2;       // the same, starting from the previous round's result

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
  for (std::size_t v = 0; v < person.views.size(); ++v) seen_[v].eye = person.views[v].eye;
  for (std::size_t j = 0; j < kJointCount; ++j) take(j, instant, errors, biases);
}

void SightedBody::take(std::size_t j, const Instant& instant, const ErrorModel& errors,
                       const Biases& biases) {
  const auto joint = static_cast<JointId>(j);
  Sights& sights = sights_[j];
  sights.views = points_and_rays_of(joint, person_, instant.sensors, errors);
  sights.trust.assign(sights.views.size(), 1.0);
  for (JointView& view : sights.views) {
    const bool own = view.joint.covariance.known();
    if (own || view.joint.bears()) sights.round = false;
    sights.stated.push_back(mean_variance(view.covariance));
    if (!own && view.joint.seen()) {
      sights.stated.back() += pose_variance(config_.pose_error, joint, view.joint.state);
      view.covariance += round_covariance(weighed_pose(config_, joint, view.joint.state));
    }
    sights.variance.push_back(mean_variance(view.covariance));
    sights.bias.emplace_back(Eigen::Vector3d::Zero());
    if (!view.joint.seen()) continue;
    const auto bias = biases.find(person_.views[view.view].sensor);
    if (bias != biases.end()) sights.bias.back() = bias->second[j];
    view.joint.position -= sights.bias.back();
    seen_[view.view].place[j] = view.joint.position;
    seen_[view.view].information[j] = view.covariance.inverse();
  }
}

void SightedBody::settle(const HeldBones& bones, const PlacedBody& expected,
                         const BodyModel& model) {
  place_all(expected, nullptr);
  for (int round = 0; round < kRounds; ++round) {
    const PlacedBody held = hold_bones(placed_, bones, 1);
    mend(held, model);
    place_all(expected, &held);
  }
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
      const Eigen::Vector3d& place = sights.views[v].joint.position;
      // A view with a known bias is still less reliable, so its bias counts as distance, too.
      const Eigen::Vector3d off = place + sights.bias[v] - joint.position;
      const double distance = off.norm() / std::sqrt(sights.variance[v]);
      const bool weigh = joint.placed && huber > 0 && distance > huber;
      sights.trust[v] = weigh ? huber / distance : 1.0;
      sum += sights.trust[v] / sights.variance[v] * place;
      information += sights.trust[v] / sights.variance[v];
    }
    joint = {sum / information, round_covariance(1.0 / information), true};
  }
  return joint;
}

PlacedJoint SightedBody::robust_squares(Sights& sights, const PlacedJoint& expected) const {
  auto found = least_squares(sights.views, config_.huber);
  const bool open = !found || largest_sigma(found->covariance) > config_.max_sigma;
  sights.bounded = open;
  if (open && expected.placed) {
    std::vector<JointView> views = sights.views;
    views.emplace_back().joint.position = expected.position;
    views.back().joint.state = JointState::Inferred;
    views.back().covariance = expected.covariance;
    found = least_squares(views, config_.huber);
  }
  if (!found || largest_sigma(found->covariance) > config_.max_sigma) return {};
  sights.trust = found->trust;
  return {found->position, found->covariance, true};
}

void SightedBody::mend(const PlacedBody& body, const BodyModel& model) {
  if (!(model.scale > 0) && !(model.turn > 0)) return;
  for (std::size_t v = 0; v < seen_.size(); ++v) {
    misfits_[v] = misfit_of(seen_[v], body, misfits_[v], model);
  }
  std::vector<std::array<Eigen::Vector3d, kJointCount>> places;
  for (std::size_t v = 0; v < seen_.size(); ++v)
    places.push_back(mended(seen_[v], body, misfits_[v]));
  for (std::size_t j = 0; j < kJointCount; ++j) {
    for (JointView& view : sights_[j].views) {
      if (view.joint.seen()) view.joint.position = places[view.view][j];
    }
  }
}

void SightedBody::learn(Biases& biases, const PlacedBody& body, double passed) const {
  const BodyModel& model = config_.body;
  const double kept = std::exp(-passed / seconds(model.bias_memory));
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

Eigen::Matrix3d SightedBody::stated(std::size_t joint) const {
  const Sights& sights = sights_[joint];
  if (!sights.round) return placed_[joint].covariance;
  double information = 0.0;
  for (std::size_t v = 0; v < sights.views.size(); ++v) {
    information += sights.trust[v] / sights.stated[v];
  }
  return round_covariance(1.0 / information);
}

std::optional<double> SightedBody::disagreement(const PlacedBody& body) const {
  constexpr double kAxes = 3.0;
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Sights& sights = sights_[j];
    if (!determined(j) || !sights.round || sights.views.size() < 2) continue;
    for (std::size_t v = 0; v < sights.views.size(); ++v) {
      const Eigen::Vector3d off = sights.views[v].joint.position - body[j].position;
      sum += sights.trust[v] * off.squaredNorm() / (kAxes * sights.variance[v]);
      count += 1.0;
    }
  }
  if (count == 0.0) return std::nullopt;
  return sum / count;
}

std::optional<double> SightedBody::scale_square() const {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t v = 0; v < seen_.size(); ++v) {
    if (!has_points(seen_[v])) continue;
    sum += misfits_[v].scale * misfits_[v].scale;  // rays alone have no size
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
  for (std::size_t v = 0; v < sights.views.size(); ++v) {
    if (sights.trust[v] == 0.0) continue;
    const JointView& view = sights.views[v];
    fused.joint.state = std::max(fused.joint.state, view.joint.state);
    fused.contributors |= view.contributor;
    if (!is_unit(view.joint.orientation)) continue;
    rotations.push_back(about_y(-misfits_[view.view].turn) * view.joint.orientation);
    weights.push_back(sights.trust[v] / sights.variance[v]);
  }
  if (!rotations.empty()) fused.joint.orientation = weighted_lerp(rotations, weights);
  return fused;
}

}  // namespace chorus::fusion
