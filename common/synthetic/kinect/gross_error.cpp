#include "common/synthetic/kinect/gross_error.h"

#include <array>
#include <cmath>

#include "common/synthetic/draw.h"

namespace chorus::synthetic::kinect {
namespace {

enum Purpose : std::uint64_t { kGhost = 941, kGhostPlace, kSwap, kIds };

// Ids of people are up to kMaxId, those of ghosts from kGhostId on, so they never coincide.
constexpr std::uint64_t kMaxId = 800'000;
constexpr std::uint64_t kGhostId = 900'000;
constexpr std::uint64_t kGhostIds = 1000;

using enum JointId;
constexpr std::array kLeft{KneeLeft, AnkleLeft, FootLeft};
constexpr std::array kRight{KneeRight, AnkleRight, FootRight};

double bearing(const Eigen::Vector3d& x) { return std::atan2(x.x(), x.z()); }

}  // namespace

void merge_legs(Skeleton<SensorSpace>& body, const GrossError& gross) {
  if (!(gross.leg_merge > 0)) return;
  for (std::size_t i = 0; i < kLeft.size(); ++i) {
    Joint& left = body[kLeft[i]];
    Joint& right = body[kRight[i]];
    if (!left.seen() || !right.seen()) continue;
    if (std::abs(bearing(left.position) - bearing(right.position)) > gross.merge_angle) continue;
    Joint& far = left.position.z() > right.position.z() ? left : right;
    const Joint& near = &far == &left ? right : left;
    far.position += gross.leg_merge * (near.position - far.position);
    far.state = JointState::Inferred;
  }
}

std::optional<BodyFrame> ghost(const GrossError& gross, double time, const ErrorKeys& keys) {
  if (!(gross.ghost_time > 0)) return std::nullopt;
  const auto block = static_cast<std::uint64_t>(std::max(0.0, time / gross.ghost_time));
  Draw draw{kGhost, keys.seed, keys.sensor, block};
  if (draw.uniform() >= gross.ghosts_per_minute * gross.ghost_time / 60.0) return std::nullopt;
  Draw place{kGhostPlace, keys.seed, keys.sensor};  // the same piece of furniture each time
  const Eigen::Vector3d base(place.uniform(-gross.ghost_aside, gross.ghost_aside),
                             -gross.ghost_below, place.uniform(gross.ghost_near, gross.ghost_far));
  BodyFrame body{BodyId{kGhostId + block % kGhostIds}, Timestamp{}, {}};
  for (Joint& joint : body.skeleton.joints) {
    joint.position = base + gross.ghost_limb * place.gauss3();
    joint.state = JointState::Inferred;
  }
  constexpr std::array kTrunk{SpineBase, SpineMid, SpineShoulder, Neck, Head};
  for (std::size_t i = 0; i < kTrunk.size(); ++i) {
    body.skeleton[kTrunk[i]].position =
        base + gross.ghost_joint * static_cast<double>(i) * Eigen::Vector3d::UnitY();
    body.skeleton[kTrunk[i]].state = JointState::Tracked;
  }
  return body;
}

IdBook::IdBook(const ErrorKeys& keys, std::size_t people)
    : keys_(keys), touching_(people, std::vector<bool>(people, false)) {
  for (std::size_t person = 0; person < people; ++person) {
    ids_.push_back(BodyId{1 + Draw{kIds, keys.seed, keys.sensor, person}.bits() % kMaxId});
  }
}

void IdBook::look(const std::vector<Eigen::Vector3d>& cores, const GrossError& gross, double time) {
  const auto stamp = static_cast<std::uint64_t>(std::max(0.0, time * 1e3));
  for (std::size_t a = 0; a < ids_.size(); ++a) {
    for (std::size_t b = a + 1; b < ids_.size(); ++b) {
      const bool touch = cores[a].allFinite() && cores[b].allFinite() &&
                         (cores[a] - cores[b]).norm() < gross.contact;
      if (touch && !touching_[a][b] &&
          Draw{kSwap, keys_.seed, keys_.sensor, a, b, stamp}.uniform() < gross.id_swap) {
        std::swap(ids_[a], ids_[b]);
      }
      touching_[a][b] = touch;
    }
  }
}

}  // namespace chorus::synthetic::kinect
