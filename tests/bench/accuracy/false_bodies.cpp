#include "tests/bench/accuracy/false_bodies.h"

#include <cmath>

#include "common/body/bones.h"
#include "common/synthetic/draw.h"

namespace chorus::bench {
namespace {

constexpr std::size_t kFirst = 1, kLast = 2;  // The two sensors that are deceived.

/// Their poses, in the world of the first sensor, and the horizontal direction in which they look.
struct Deceived {
  Eigen::Isometry3d world_from_sensor[2];
  Eigen::Vector3d ahead = Eigen::Vector3d::Zero();
};

Deceived deceived_of(const Workshop& workshop) {
  Deceived two;
  for (std::size_t i = kFirst; i <= kLast; ++i) {
    Eigen::Isometry3d& place = two.world_from_sensor[i - kFirst];
    place = true_place(workshop, workshop.tracks[i].sensor, workshop.tracks.front().sensor);
    two.ahead += place.linear().col(2);
  }
  two.ahead.y() = 0.0;
  two.ahead.normalize();
  return two;
}

/// Where the sensors' axes meet, more or less: 3 m ahead of them.
Eigen::Vector3d middle_of(const Deceived& two) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& place : two.world_from_sensor)
    sum += 0.5 * (place * Eigen::Vector3d(0.0, 0.0, 3.0));
  return sum;
}

/// What a tracker errs by at a joint of the image [m], independently of its error at the person:
/// about as much as profile A.
Eigen::Vector3d error_of(const BodyFrame& image, Timestamp instant, std::size_t joint) {
  constexpr double kError = 0.02;  // in each direction
  const auto time = static_cast<std::uint64_t>(instant.time_since_epoch().count());
  return kError * synthetic::Draw({image.id.value, time, joint}).gauss3();
}

struct Mirror {
  Eigen::Vector3d foot = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
};

/// The image of the body: what is the person's right is its left, as a tracker shows it.
BodyFrame image_of(const BodyFrame& body, const Eigen::Isometry3d& world_from_sensor,
                   const Mirror& mirror, Timestamp instant) {
  BodyFrame image = body;
  image.id = BodyId{body.id.value + 1000};
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Joint& joint = image.skeleton.joints[i];
    joint = body.skeleton[chorus::mirror(static_cast<JointId>(i))];
    if (!joint.seen()) continue;
    Eigen::Vector3d place = world_from_sensor * joint.position;
    place -= 2.0 * mirror.normal.dot(place - mirror.foot) * mirror.normal;
    joint.position = world_from_sensor.inverse() * (place + error_of(image, instant, i));
  }
  return image;
}

}  // namespace

void stand_a_mirror(Workshop& workshop) {
  constexpr double kBehindMiddle = 0.7;  // [m]; people cross within 0.5 m of the middle
  const Deceived two = deceived_of(workshop);
  const Mirror mirror{middle_of(two) + kBehindMiddle * two.ahead, two.ahead};
  for (std::size_t i = kFirst; i <= kLast; ++i) {
    const Eigen::Isometry3d& place = two.world_from_sensor[i - kFirst];
    for (SensorFrame& frame : workshop.tracks[i].frames) {
      const std::size_t people = frame.bodies.size();
      for (std::size_t b = 0; b < people; ++b) {
        const Eigen::Vector3d core = place * frame.bodies[b].skeleton[JointId::SpineMid].position;
        const Eigen::Vector3d from = core - mirror.foot;
        const double before = -two.ahead.dot(from);
        const double along = from.cross(two.ahead).y();
        if (before < 0.25 || before > 1.0 || std::abs(along) > 1.5) continue;
        frame.bodies.push_back(image_of(frame.bodies[b], place, mirror, frame.captured));
      }
    }
  }
}

void let_two_lie(Workshop& workshop) {
  const Deceived two = deceived_of(workshop);
  const Eigen::Vector3d aside = two.ahead.cross(Eigen::Vector3d::UnitY());
  for (std::size_t i = kFirst; i <= kLast; ++i) {
    const Eigen::Matrix3d turned = two.world_from_sensor[i - kFirst].linear().transpose();
    for (SensorFrame& frame : workshop.tracks[i].frames) {
      for (BodyFrame& body : frame.bodies) {
        for (Joint& joint : body.skeleton.joints) {
          if (joint.seen()) joint.position += turned * aside;
        }
      }
    }
  }
}

}  // namespace chorus::bench
