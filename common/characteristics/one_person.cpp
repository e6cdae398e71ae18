#include "common/characteristics/one_person.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/base/duration.h"
#include "common/base/median.h"

namespace chorus::characteristics {
namespace {

constexpr std::array kTrunk{JointId::SpineBase, JointId::SpineMid, JointId::SpineShoulder,
                            JointId::Neck};
constexpr double kMostCrowded = 0.1;  // share of frames with more than one body
constexpr Duration kSpeedOver = std::chrono::milliseconds(500);  // to either side
constexpr std::size_t kFewestFrames = 30;

Eigen::Quaterniond upright(const std::vector<SensorFrame>& frames, bool& has_floor) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const SensorFrame& frame : frames) {
    if (frame.floor) normal += frame.floor->normal;
  }
  has_floor = normal.norm() > 0.0;
  if (!has_floor) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond::FromTwoVectors(normal, Eigen::Vector3d::UnitY());
}

/// The body whose trunk is nearest to `before`; the first one where there is none.
const BodyFrame* same_body(const std::vector<BodyFrame>& bodies, const Eigen::Vector3d* before) {
  const BodyFrame* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const BodyFrame& body : bodies) {
    const auto trunk = trunk_of(body.skeleton);
    if (!trunk) continue;
    const double away = before != nullptr ? (*trunk - *before).norm() : 0.0;
    if (away >= least) continue;
    best = &body;
    least = away;
  }
  return best;
}

void take_sights(const std::vector<SensorFrame>& frames, OnePerson& person) {
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (const SensorFrame& frame : frames) {
    const BodyFrame* body = same_body(frame.bodies, person.sights.empty() ? nullptr : &before);
    if (body == nullptr) continue;
    before = trunk_of(body->skeleton).value_or(before);
    Sight sight{body->captured, body->skeleton};
    for (Joint& joint : sight.body.joints) {
      joint.position = person.upright_from_sensor * joint.position;
    }
    person.sights.push_back(std::move(sight));
  }
}

/// Decides where the person stands, by how far the trunk moves in a second.
void find_standing(std::vector<Sight>& sights) {
  std::size_t from = 0;
  std::size_t to = 0;
  for (Sight& sight : sights) {
    while (sights[from].at < sight.at - kSpeedOver) ++from;
    while (to + 1 < sights.size() && sights[to + 1].at <= sight.at + kSpeedOver) ++to;
    const double lasts = seconds(sights[to].at - sights[from].at);
    if (lasts < seconds(kSpeedOver)) continue;
    Eigen::Vector3d way = *trunk_of(sights[to].body) - *trunk_of(sights[from].body);
    way.y() = 0;
    sight.standing = way.norm() < kStandingSpeed * lasts;
  }
}

/// Median time between frames [s].
double step_of(const std::vector<Timestamp>& frames) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < frames.size(); ++i)
    steps.push_back(seconds(frames[i] - frames[i - 1]));
  return median(std::move(steps));
}

Result<void> check_bodies(const std::vector<SensorFrame>& frames, const std::string& sensor) {
  const auto count = [&](auto&& is) { return std::ranges::count_if(frames, is); };
  const auto with = [](std::size_t least) {
    return [least](const SensorFrame& frame) { return frame.bodies.size() >= least; };
  };
  const auto somebody = count(with(1));
  if (somebody == 0 || frames.size() < kFewestFrames)
    return fail(ErrorCode::InvalidArgument, sensor,
                "saw nobody: record a person, or a mannequin, who stands 2 to 3 m in front of it");
  if (static_cast<double>(count(with(2))) > kMostCrowded * static_cast<double>(somebody))
    return fail(ErrorCode::InvalidArgument, sensor,
                "saw several people at once: record one person alone");
  const auto rays = count([](const SensorFrame& frame) {
    return std::ranges::any_of(
        frame.bodies, [](const BodyFrame& body) { return has_rays_alone(body.skeleton.joints); });
  });
  if (2 * rays > somebody)
    return fail(ErrorCode::InvalidArgument, sensor,
                "shows directions without distances (rays), of which this measures nothing; of a "
                "camera `chorus calibrate camera` measures the lens");
  return {};
}

Result<void> check_standing(const OnePerson& person) {
  const double seen = person.step * static_cast<double>(person.sights.size());
  const auto standing = std::ranges::count_if(person.sights, &Sight::standing);
  const double stood = person.step * static_cast<double>(standing);
  if (seen < kLeastStanding)
    return fail(ErrorCode::InvalidArgument, person.sensor.str(),
                fmt::format("saw the person for {:.1f} s: record at least {:.0f} s, better a "
                            "minute",
                            seen, kLeastStanding));
  if (stood < kLeastStanding)
    return fail(ErrorCode::InvalidArgument, person.sensor.str(),
                fmt::format("saw the person walk, and stand for {:.1f} s only: record somebody who "
                            "stays on one spot for at least {:.0f} s and turns there",
                            stood, kLeastStanding));
  return {};
}

}  // namespace

std::optional<Eigen::Vector3d> trunk_of(const Skeleton<SensorSpace>& body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const JointId id : kTrunk) {
    if (!body[id].seen()) continue;
    sum += body[id].position;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return (sum / count).eval();
}

Result<OnePerson> one_person(const std::vector<SensorFrame>& frames) {
  OnePerson person;
  const std::string sensor = frames.empty() ? "the sensor" : frames.front().sensor.str();
  if (auto ok = check_bodies(frames, sensor); !ok) return pass(ok);
  person.sensor = frames.front().sensor;
  person.upright_from_sensor = upright(frames, person.has_floor);
  for (const SensorFrame& frame : frames) person.frames.push_back(frame.captured);
  person.step = step_of(person.frames);
  take_sights(frames, person);
  find_standing(person.sights);
  if (auto ok = check_standing(person); !ok) return pass(ok);
  return person;
}

}  // namespace chorus::characteristics
