#include "tests/bench/methods/kalman.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "common/base/units.h"
#include "fusion-server/associate/person_association.h"
#include "fusion-server/facing/sides.h"
#include "fusion-server/fusion/joint_filters.h"

namespace chorus::bench::baselines {
namespace {

constexpr double kTrackedSigma = mm(25);
constexpr double kInferredSigma = mm(75);

/// The filters of one person.
struct BodyFilter {
  fusion::JointFilters joints = fusion::joint_filters();
  std::array<Timestamp, kJointCount> seen{};
  std::array<JointState, kJointCount> state{};

  void update(std::size_t joint, Timestamp instant, const Joint& sight, double variance) {
    state[joint] = seen[joint] == instant ? std::max(state[joint], sight.state) : sight.state;
    seen[joint] = instant;
    joints[joint].update(instant, sight.position, variance);
  }

  /// Joints last seen at or after `since`, predicted for `instant`.
  [[nodiscard]] Body at(Timestamp instant, Timestamp since) const {
    Body body;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const auto position = joints[i].at(instant);
      if (!position || seen[i] < since) continue;
      body.joints[i].position = *position;
      body.joints[i].state = state[i];
    }
    return body;
  }
};

/// The frames of all sensors in their order of arrival.
std::vector<std::pair<const registration::WalkTrack*, const SensorFrame*>> by_arrival(
    const std::vector<registration::WalkTrack>& sensors) {
  std::vector<std::pair<const registration::WalkTrack*, const SensorFrame*>> frames;
  for (const auto& track : sensors) {
    for (const SensorFrame& frame : track.frames) frames.emplace_back(&track, &frame);
  }
  std::ranges::stable_sort(frames, {}, [](const auto& entry) { return entry.second->received; });
  return frames;
}

std::vector<SensorView> views_of(const SensorFrame& frame, const SensorId& sensor,
                                 const Eigen::Isometry3d& world_from_sensor) {
  std::vector<SensorView> views;
  for (const BodyFrame& body : frame.bodies) {
    SensorView view;
    view.sensor = sensor;
    view.body = body.id;
    view.eye = world_from_sensor.translation();
    view.skeleton = to_world(world_from_sensor, body.skeleton);
    views.push_back(std::move(view));
  }
  return views;
}

void update(BodyFilter& filter, const Person& person, Timestamp arrived) {
  for (const SensorView& view : person.views) {
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const Joint& sight = view.skeleton.joints[i];
      if (!sight.seen()) continue;
      const double sigma = sight.state == JointState::Tracked ? kTrackedSigma : kInferredSigma;
      filter.update(i, arrived, sight, sigma * sigma);
    }
  }
}

}  // namespace

std::vector<Stated> arrival_kalman(const std::vector<registration::WalkTrack>& sensors,
                                   const Registration& registration) {
  constexpr Duration kPast =
      std::chrono::milliseconds(100);  // a joint not seen for this long is dropped
  std::map<PersonId, BodyFilter> filters;
  associate::Tracks tracks;
  facing::SidesMemory sides;
  std::vector<Stated> answers;
  for (const auto& [track, frame] : by_arrival(sensors)) {
    const auto place = registration.sensors.find(track->sensor);
    if (place == registration.sensors.end()) continue;
    const Timestamp arrived = frame->received;
    auto grouping = associate::group(
        {arrived, views_of(*frame, track->sensor, place->second.world_from_sensor)}, tracks, {});
    tracks = std::move(grouping.tracks);
    for (Person& person : grouping.people) {
      BodyFilter& filter = filters[person.id];
      facing::resolve_sides(person, arrived, sides, {});
      update(filter, person, arrived);
      answers.push_back({arrived, person.id, filter.at(arrived, arrived - kPast)});
    }
  }
  return answers;
}

}  // namespace chorus::bench::baselines
