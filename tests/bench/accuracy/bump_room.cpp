#include "tests/bench/accuracy/bump_room.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "common/geometry/rotation.h"
#include "fusion-server/core/fusion_core.h"
#include "tests/judge/place_error.h"

namespace chorus::bench {
namespace {

using std::chrono::milliseconds;
using synthetic::BodySensor;

SensorId sensor_of(std::size_t place) {
  return SensorId::parse(fmt::format("s{}", place + 1)).value();
}

std::vector<Eigen::Isometry3d> places_of(const RoomSetting& setting) {
  constexpr std::size_t kSeenTogether = 3;  // two sensors stand like two of a ring of three
  synthetic::Ring ring;
  ring.count = std::max(setting.sensors, kSeenTogether);
  auto places = ring_places(ring);
  places.resize(setting.sensors);
  return places;
}

Eigen::Isometry3d pushed(const Eigen::Isometry3d& place, const Push& push) {
  Eigen::Isometry3d out = place;
  out.linear() = about_y(push.yaw).toRotationMatrix() * place.linear();
  out.translation() += push.shift;
  return out;
}

/// A sensor, which is replaced by another object when it is pushed, and the next frame that it
/// will deliver.
struct Lane {
  std::unique_ptr<BodySensor> sensor;
  std::optional<SensorFrame> next;
};

class Room {
 public:
  explicit Room(const RoomSetting& setting);
  RoomLog run();

 private:
  [[nodiscard]] std::unique_ptr<BodySensor> make(const synthetic::Scene& scene, std::size_t place,
                                                 Timestamp from) const;
  void advance(Lane& lane) const;
  void push();
  void take(SensorFrame frame);
  void note_alarms(Timestamp now);
  void score(const Snapshot& snapshot);
  void work(Timestamp now);
  [[nodiscard]] bool is_pushed(Timestamp now) const {
    return setting_.push && now >= begin_ + setting_.push->at;
  }
  [[nodiscard]] core::CoreConfig config() const;

  RoomSetting setting_;
  Timestamp begin_;
  synthetic::Scene scene_;
  synthetic::Scene after_;  ///< The scene with one sensor moved.
  Eigen::Isometry3d world_from_scene_;
  Eigen::Isometry3d pushed_place_;  ///< Pose of the pushed sensor in the tracker's world.
  std::optional<core::FusionCore> core_;
  std::vector<Lane> lanes_;
  std::set<SensorId> alarmed_;
  bool lost_ = false;                           ///< The pushed sensor has lost its place.
  std::map<PersonId, Eigen::Vector3d> errors_;  ///< Error of the trunk at the previous instant.
  RoomLog log_;
  double before_sum_ = 0.0, after_sum_ = 0.0;
  std::size_t before_count_ = 0, after_count_ = 0;
};

core::CoreConfig Room::config() const {
  core::CoreConfig config;
  for (std::size_t i = 0; i < setting_.sensors; ++i) config.sensors.insert(sensor_of(i));
  config.watch = setting_.watch;
  return config;
}

Room::Room(const RoomSetting& setting) : setting_(setting) {
  Setting walk;
  walk.profile = setting.profile;
  walk.seed = setting.seed;
  walk.places = places_of(setting);
  const Workshop workshop = draw_workshop(walk);
  Registration registration =
      registration::solve(workshop.tracks, workshop.begin, registration::RegistrationConfig{});
  begin_ = workshop.begin + std::chrono::seconds(60);
  world_from_scene_ = world_from_scene(workshop, registration.master);
  scene_ = workshop.scene;
  if (setting.persons > 1) {
    synthetic::WalkerScript script;
    script.seed = setting.seed;
    scene_.people = synthetic::make_people(script, setting.persons);
  }
  after_ = scene_;
  if (setting.push) {
    Eigen::Isometry3d& place = after_.world_from_sensor[setting.push->sensor];
    place = pushed(place, *setting.push);
    pushed_place_ = world_from_scene_ * place;
  }
  core_.emplace(config(), std::move(registration));
  for (std::size_t i = 0; i < setting.sensors; ++i) {
    lanes_.push_back({make(scene_, i, begin_), std::nullopt});
    advance(lanes_.back());
  }
}

std::unique_ptr<BodySensor> Room::make(const synthetic::Scene& scene, std::size_t place,
                                       Timestamp from) const {
  synthetic::SensorChoice choice{
      sensor_of(place), place, setting_.profile, setting_.seed, {}, setting_.seed, setting_.seed};
  choice.own_clock = false;
  return make_sensor(scene, choice, from).value();
}

void Room::advance(Lane& lane) const {
  const Timestamp end = begin_ + setting_.length + std::chrono::seconds(1);
  lane.next.reset();
  while (!lane.next && lane.sensor->next_exposure() < end) lane.next = lane.sensor->next();
}

/// From now on the pushed sensor sees the scene from its new pose.
void Room::push() {
  Lane& lane = lanes_[setting_.push->sensor];
  lane.sensor = make(after_, setting_.push->sensor, begin_ + setting_.push->at);
  advance(lane);
}

void Room::note_alarms(Timestamp now) {
  for (std::size_t i = 0; i < setting_.sensors; ++i) {
    const SensorId sensor = sensor_of(i);
    const auto alarm = core_->guard().alarm_of(sensor);
    if (!alarm) {
      alarmed_.erase(sensor);
    } else if (alarmed_.insert(sensor).second) {
      log_.alarms.push_back({now - begin_, i, alarm->or_else.has_value()});
    }
  }
  if (!is_pushed(now) || log_.placed_again) return;
  const SensorId sensor = sensor_of(setting_.push->sensor);
  const bool placed = core_->registration().sensors.contains(sensor);
  if (!placed) lost_ = true;
  if (placed && lost_) log_.placed_again = now - begin_;
}

std::optional<Eigen::Vector3d> trunk_of(const Skeleton<WorldSpace>& body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto joints = {JointId::Neck, JointId::SpineShoulder, JointId::SpineMid};
  for (const JointId joint : joints) {
    if (!body[joint].seen()) return std::nullopt;
    sum += body[joint].position;
  }
  return sum / static_cast<double>(joints.size());
}

void Room::score(const Snapshot& snapshot) {
  constexpr Duration kAverage = std::chrono::seconds(10);
  constexpr double kSomebodyElse = 0.5;  // [m]
  std::map<PersonId, Eigen::Vector3d> errors;
  for (const FusedBody& body : snapshot.bodies) {
    const auto trunk = trunk_of(body.skeleton);
    if (!trunk || body.carried_for) continue;
    Eigen::Vector3d error = Eigen::Vector3d::Constant(kSomebodyElse);
    for (std::size_t i = 0; i < scene_.people.size(); ++i) {
      const auto exact = truth(scene_, i, snapshot.instant);
      const Eigen::Vector3d off = *trunk - world_from_scene_ * *trunk_of(exact);
      if (off.norm() < error.norm()) error = off;
    }
    const auto last = errors_.find(body.id);
    const bool after = is_pushed(snapshot.instant);
    if (last != errors_.end()) {
      double& step = after ? log_.step_after : log_.step_before;
      step = std::max(step, (error - last->second).norm());
    }
    errors[body.id] = error;
    const Duration at = snapshot.instant - begin_;
    if (!after && setting_.push && at > setting_.push->at - kAverage) {
      before_sum_ += error.norm();
      ++before_count_;
    }
    if (after && at > setting_.length - kAverage) {
      after_sum_ += error.norm();
      ++after_count_;
    }
  }
  errors_ = std::move(errors);
}

/// Carries out solve jobs as soon as they are due; in a server the worker does this.
void Room::work(Timestamp now) {
  const auto job = core_->due_job(now);
  if (!job) return;
  core::Solution solution{job->session, job->kind, {}, milliseconds(300), false};
  solution.registration = registration::solve(core::assembled(job->walk), now, job->config);
  core_->solved(std::move(solution), now);
}

void Room::take(SensorFrame frame) {
  const Timestamp now = frame.received;
  core_->take(std::move(frame));
  while (auto snapshot = core_->tick(now)) score(*snapshot);
  note_alarms(now);
  work(now);
}

RoomLog Room::run() {
  bool waits = setting_.push.has_value();
  const Timestamp end = begin_ + setting_.length;
  for (;;) {
    const auto first = std::ranges::min_element(lanes_, [](const Lane& a, const Lane& b) {
      return a.next && (!b.next || a.next->received < b.next->received);
    });
    if (!first->next || first->next->received > end) break;
    if (waits && first->next->captured >= begin_ + setting_.push->at) {
      push();
      waits = false;
      continue;
    }
    take(*std::exchange(first->next, std::nullopt));
    advance(*first);
  }
  log_.walked = chorus::seconds(setting_.length);
  log_.body_error_before = before_sum_ / static_cast<double>(before_count_);
  log_.body_error_after = after_sum_ / static_cast<double>(after_count_);
  if (log_.placed_again) {
    const auto& places = core_->registration().sensors;
    const auto place = places.find(sensor_of(setting_.push->sensor));
    if (place != places.end())
      log_.place_again_error = place_error(place->second.world_from_sensor, pushed_place_).position;
  }
  return std::move(log_);
}

}  // namespace

RoomLog live_in(const RoomSetting& setting) { return Room(setting).run(); }

}  // namespace chorus::bench
