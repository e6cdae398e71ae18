#include "tests/bench/quality/planted_faults.h"

#include <algorithm>
#include <random>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::bench {
namespace {

using Frames = std::vector<SensorFrame>;
using std::chrono::milliseconds;

constexpr std::array kLeftHand{JointId::WristLeft, JointId::HandLeft, JointId::HandTipLeft,
                               JointId::ThumbLeft};
constexpr std::array kFeet{JointId::AnkleLeft, JointId::FootLeft, JointId::AnkleRight,
                           JointId::FootRight};

Timestamp middle_of(const Frames& frames) {
  return frames.front().captured + (frames.back().captured - frames.front().captured) / 2;
}

/// Sensor number `place`, counted from 1 as in its name.
Frames& of(SensorTracks& tracks, std::size_t place) { return tracks.at(place - 1).frames; }

void move(SensorFrame& frame, const Eigen::Isometry3d& by) {
  for (BodyFrame& body : frame.bodies)
    for (Joint& joint : body.skeleton.joints)
      if (joint.seen()) joint.position = by * joint.position;
}

Eigen::Isometry3d shift(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

template <class Change>
auto each_frame(std::size_t sensor, const Change& change) {
  return [=](DaySetting& day) {
    day.in_views = [=](SensorTracks& tracks) {
      for (SensorFrame& frame : of(tracks, sensor)) change(frame);
    };
  };
}

template <class Change>
auto second_half(std::size_t sensor, const Change& change) {
  return [=](DaySetting& day) {
    day.in_views = [=](SensorTracks& tracks) {
      Frames& frames = of(tracks, sensor);
      const Timestamp middle = middle_of(frames);
      for (SensorFrame& frame : frames)
        if (frame.captured > middle) change(frame);
    };
  };
}

/// Hides joints from all sensors in that share of every ten seconds.
template <std::size_t N>
auto hidden(const std::array<JointId, N>& joints, double share) {
  return [=](DaySetting& day) {
    day.in_views = [=](SensorTracks& tracks) {
      for (registration::WalkTrack& track : tracks)
        for (SensorFrame& frame : track.frames) {
          if (std::fmod(seconds(frame.captured.time_since_epoch()), 10.0) > 10.0 * share) continue;
          for (BodyFrame& body : frame.bodies)
            for (const JointId id : joints) body.skeleton[id].state = JointState::NotTracked;
        }
    };
  };
}

template <class Drop>
auto dropped(std::size_t sensor, const Drop& drop) {
  return [=](DaySetting& day) {
    day.in_views = [=](SensorTracks& tracks) {
      Frames& frames = of(tracks, sensor);
      const Timestamp begin = frames.front().captured;
      std::erase_if(frames, [&](const SensorFrame& frame) {
        return drop(seconds(frame.captured - begin), frame.sequence);
      });
    };
  };
}

template <class Change>
auto in_output(const Change& change) {
  return [=](DaySetting& day) { day.in_fused = change; };
}

void exchange(std::array<resource::JointResource, kJointCount>& joints) {
  for (const auto& [left, right] : kMirrorPairs)
    std::swap(joints[index_of(left)], joints[index_of(right)]);
}

void exchange_sides(SensorFrame& frame) {
  for (BodyFrame& body : frame.bodies)
    for (const auto& [left, right] : kMirrorPairs)
      std::swap(body.skeleton[left], body.skeleton[right]);
}

void add_noise(SensorFrame& frame, double sigma) {
  std::mt19937_64 random(frame.sequence);
  std::normal_distribution<double> normal(0.0, sigma);
  for (BodyFrame& body : frame.bodies)
    for (Joint& joint : body.skeleton.joints)
      joint.position += Eigen::Vector3d(normal(random), normal(random), normal(random));
}

void scale(SensorFrame& frame, double by) {
  for (BodyFrame& body : frame.bodies)
    for (Joint& joint : body.skeleton.joints) joint.position *= by;
}

/// The frames' bodies stay as they are from the middle on; their times go on.
void freeze(Frames& frames) {
  const Timestamp middle = middle_of(frames);
  const SensorFrame* last = nullptr;
  for (SensorFrame& frame : frames) {
    if (frame.captured <= middle || last == nullptr) {
      if (!frame.bodies.empty()) last = &frame;
      continue;
    }
    frame.bodies = last->bodies;
    for (BodyFrame& body : frame.bodies) body.captured = frame.captured;
  }
}

void publish_twice(FusedFrames& frames) {
  for (std::size_t i = frames.size() / 3; i < frames.size() / 3 + 60; ++i) {
    if (frames[i].bodies.empty()) continue;
    resource::BodyResource ghost = frames[i].bodies.front();
    ghost.id += 1000;
    for (auto& joint : ghost.joints) joint.position.x() += 0.1;
    frames[i].bodies.push_back(ghost);
  }
}

void leap_often(FusedFrames& frames) {
  for (std::size_t i = 50; i < frames.size(); i += 90)
    for (auto& body : frames[i].bodies)
      body.joints[index_of(JointId::WristRight)].position.y() += 0.3;
}

void boast(FusedFrames& frames) {
  constexpr double kShare = 1.0 / 16.0;  // a quarter of the standard deviation
  for (auto& frame : frames)
    for (auto& body : frame.bodies)
      for (auto& joint : body.joints) {
        if (joint.variance) *joint.variance *= kShare;
        if (joint.covariance.known())
          joint.covariance = Covariance(joint.covariance.matrix() * kShare);
      }
}

std::vector<PlantedFault> of_places_and_clocks() {
  const auto late = [](int ms) {
    return [=](SensorFrame& frame) { move_in_time(frame, milliseconds(ms)); };
  };
  return {
      {"moved-120mm",
       {"s2", "moved"},
       second_half(2, [](SensorFrame& f) { move(f, shift(0.12, 0, 0)); })},
      {"moved-70mm-deep",
       {"s5", "moved"},
       second_half(5, [](SensorFrame& f) { move(f, shift(0, 0, 0.07)); })},
      {"turned-4deg",
       {"s3", "moved"},
       second_half(3, [](SensorFrame& f) { move(f, Eigen::Isometry3d(about_y(deg(4)))); })},
      {"stands-elsewhere-120mm",
       {"s4", "beside where"},
       each_frame(4, [](SensorFrame& f) { move(f, shift(0.12, 0, 0)); })},
      {"turned-before-4deg",
       {"s6", "beside where"},
       each_frame(6, [](SensorFrame& f) { move(f, Eigen::Isometry3d(about_y(deg(-4)))); })},
      {"clock-100ms", {"clock of s3"}, each_frame(3, late(100))},
      {"clock-minus-60ms", {"clock of s1"}, each_frame(1, late(-60))},
      {"clock-steps-80ms", {"clock of s5"}, second_half(5, late(80))},
  };
}

std::vector<PlantedFault> of_views() {
  return {
      {"wrist-hidden", {"WristLeft"}, hidden(kLeftHand, 0.3)},
      {"feet-hidden", {"AnkleRight"}, hidden(kFeet, 0.5)},
      {"wrong-wrist",
       {"s5", "WristRight"},
       each_frame(5,
                  [](SensorFrame& f) {
                    for (BodyFrame& body : f.bodies)
                      body.skeleton[JointId::WristRight].position +=
                          Eigen::Vector3d(0.0, 0.25, 0.0);
                  })},
      {"noisy", {"s1", "disagrees"}, each_frame(1, [](SensorFrame& f) { add_noise(f, 0.08); })},
      {"scale-1.1", {"s6", ""}, each_frame(6, [](SensorFrame& f) { scale(f, 1.1); })},
      {"mirrored", {"s2", "left and right"}, each_frame(2, exchange_sides)},
      {"frozen",
       {"s1", "same"},
       [](DaySetting& day) { day.in_views = [](SensorTracks& tracks) { freeze(of(tracks, 1)); }; }},
      {"silent-6s",
       {"s3", "silent"},
       dropped(3, [](double at, auto) { return at > 10 && at < 16; })},
      {"dies", {"s4", "silent"}, dropped(4, [](double at, auto) { return at > 15; })},
      {"slow", {"s2", "frames/s"}, dropped(2, [](double, auto number) { return number % 3 != 0; })},
      {"late-400ms",
       {"s5", "late"},
       each_frame(5, [](SensorFrame& f) { f.received += milliseconds(400); })},
  };
}

std::vector<PlantedFault> of_output() {
  return {
      {"sides-exchanged", {"left and right"}, in_output([](FusedFrames& frames) {
         for (std::size_t i = frames.size() / 2; i < frames.size() / 2 + 30; ++i)
           for (auto& body : frames[i].bodies) exchange(body.joints);
       })},
      {"doubled", {"twice"}, in_output(publish_twice)},
      {"id-changed", {"an id ended"}, in_output([](FusedFrames& frames) {
         for (std::size_t i = frames.size() / 2; i < frames.size(); ++i)
           for (auto& body : frames[i].bodies) body.id += 7;
       })},
      {"output-pauses", {"paused"}, in_output([](FusedFrames& frames) {
         frames.erase(frames.begin() + 300, frames.begin() + 360);
       })},
      {"jumps", {"WristRight", "jump"}, in_output(leap_often)},
      {"states-a-quarter", {"stated"}, in_output(boast)},
      {"provisional",
       {"registration is Provisional"},
       [](DaySetting& day) {
         day.in_registration = [](Registration& r) { r.verdict = Verdict::Provisional; };
       }},
  };
}

}  // namespace

std::vector<PlantedFault> planted_faults() {
  std::vector<PlantedFault> all = of_places_and_clocks();
  for (auto& more : {of_views(), of_output()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace chorus::bench
