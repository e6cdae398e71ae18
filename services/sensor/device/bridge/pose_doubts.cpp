#include "services/sensor/device/bridge/pose_doubts.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "common/sensor/limits.h"

namespace chorus::bridge {
namespace {

constexpr Duration kPatience = std::chrono::seconds(2);
constexpr double kClearlyBelow = 0.3;  // How far a head is below the feet before it counts [m].
constexpr std::ptrdiff_t kFewJoints = 3;

using SensorSkeleton = Skeleton<SensorSpace>;

/// Whether the body gives reason for a doubt; none if it does not show that.
using Judge = std::optional<bool> (*)(const SensorSkeleton&, const Eigen::Vector3d& up);

std::optional<bool> is_behind(const SensorSkeleton& body, const Eigen::Vector3d& /*up*/) {
  const auto& joints = body.joints;
  if (std::ranges::count_if(joints, &Joint::seen) < kFewJoints) return std::nullopt;
  return std::ranges::all_of(
      joints, [](const Joint& joint) { return !joint.seen() || joint.position.z() < 0.0; });
}

std::optional<double> height_of(const SensorSkeleton& body, const Eigen::Vector3d& up,
                                std::initializer_list<JointId> candidates) {
  for (const JointId id : candidates) {
    if (body[id].seen()) return up.dot(body[id].position);
  }
  return std::nullopt;
}

std::optional<bool> is_upside_down(const SensorSkeleton& body, const Eigen::Vector3d& up) {
  using enum JointId;
  const auto head = height_of(body, up, {Head, Neck, SpineShoulder});
  const auto feet = height_of(body, up, {AnkleLeft, AnkleRight, FootLeft, FootRight});
  if (!head || !feet) return std::nullopt;
  return *head < *feet - kClearlyBelow;
}

/// Whether all bodies of the frame that show it give reason for a doubt.
std::optional<bool> all_of(const PushedFrame& frame, const Eigen::Vector3d& up, Judge judge) {
  std::optional<bool> all;
  for (const BodyFrame& body : frame.bodies) {
    if (const auto one = judge(body.skeleton, up)) all = all.value_or(true) && *one;
  }
  return all;
}

std::array<Error, 4> doubts() {
  return {Error{ErrorCode::InvalidArgument, "bodies",
                "everybody has been behind the sensor for 2 s: does z point back? The hello's "
                "\"axes\" say where x, y and z point"},
          Error{ErrorCode::InvalidArgument, "bodies",
                "everybody has had the head below the feet for 2 s: does y point down? The hello's "
                "\"axes\" say so: \"right down ahead\""},
          Error{ErrorCode::InvalidArgument, "bodies",
                "all landmarks have been outside the picture for 2 s: are the intrinsics for "
                "another picture size?"},
          Error{ErrorCode::InvalidArgument, "bodies",
                "for 2 s every frame has had points at exactly [0, 0, 0], which are taken as not "
                "seen: send null for them"}};
}

}  // namespace

void PoseDoubts::look(const PushedFrame& frame, const Hello& hello, SteadyTime now) {
  const auto& floor = frame.floor ? frame.floor : hello.floor;
  const Eigen::Vector3d up = floor ? floor->normal : Eigen::Vector3d::UnitY();
  const std::optional<bool> zeros =
      frame.bodies.empty() ? std::nullopt : std::optional(frame.zeros > 0);
  const std::array<std::optional<bool>, kDoubts> shown{all_of(frame, up, &is_behind),
                                                       all_of(frame, up, &is_upside_down),
                                                       frame.outside_picture, zeros};
  for (std::size_t i = 0; i < kDoubts; ++i) {
    Watched& watched = watched_[i];
    if (shown[i] == false) watched = {};
    if (shown[i] != true) continue;
    if (!watched.since) watched.since = now;
    if (watched.raised || now - *watched.since < kPatience) continue;
    watched.raised = true;
    fresh_ = doubts()[i];
  }
}

std::optional<Error> PoseDoubts::take_new() { return std::exchange(fresh_, std::nullopt); }

std::string PoseDoubts::lasting() const {
  for (std::size_t i = 0; i < kDoubts; ++i) {
    if (watched_[i].raised) return to_string(doubts()[i]);
  }
  return {};
}

}  // namespace chorus::bridge
