#include "services/sensor/device/inertial/slimevr_desk.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/inertial/segment_poses.h"

namespace chorus::inertial_device {
namespace {

namespace slimevr = inertial::slimevr;
using inertial::InertialReading;

/// A number that is farther below the newest one than this is not late: the tracker began anew.
constexpr std::uint64_t kAnew = 1000;

std::string name_of_mac(const std::array<std::uint8_t, 6>& mac) {
  return fmt::format("{:02X}:{:02X}:{:02X}:{:02X}:{:02X}:{:02X}", mac[0], mac[1], mac[2], mac[3],
                     mac[4], mac[5]);
}

/// Whether the packet is new; packets without a number always are.
bool advances(std::uint64_t& newest, std::uint64_t number) {
  if (number != 0 && number <= newest && newest - number < kAnew) return false;
  if (number != 0) newest = number;
  return true;
}

}  // namespace

void SlimevrDesk::refuse(std::string why) {
  ++refused_;
  last_refusal_ = std::move(why);
}

void SlimevrDesk::greet(const std::string& from, const slimevr::Handshake& handshake,
                        Timestamp now) {
  const std::string name = name_of_mac(handshake.mac);
  // A tracker that comes back from another port or address is still the same.
  std::erase_if(trackers_,
                [&](const auto& one) { return one.second.name == name && one.first != from; });
  Tracker& tracker = trackers_[from];
  tracker.name = name;
  tracker.heard = now;
  tracker.number = 0;
}

InertialReading& SlimevrDesk::reading_of(Tracker& tracker, std::uint8_t sensor, Timestamp now) {
  InertialReading& reading = tracker.fresh[sensor];
  reading.sensor = tracker.name + (sensor == 0 ? "" : "/" + std::to_string(sensor));
  reading.captured = now;
  return reading;
}

/// Takes one packet; returns the answer if it wants one.
std::optional<std::string> SlimevrDesk::take(Tracker& tracker, const slimevr::Content& content,
                                             Timestamp now) {
  if (const auto* rotation = std::get_if<slimevr::Rotation>(&content)) {
    const Eigen::Quaterniond turned = inertial::y_up_from_z_up() * rotation->world_from_tracker;
    const auto fresh = tracker.fresh.find(rotation->sensor);
    if (fresh != tracker.fresh.end() && fresh->second.inertial_from_sensor &&
        fresh->second.captured != now) {
      if (auto complete = gather(turned_)) waiting_.push_back(std::move(*complete));
      if (waiting_.size() > inertial::kMostWaiting) waiting_.pop_front();
    }
    turned_ = now;
    tracker.latest[rotation->sensor] = turned;
    reading_of(tracker, rotation->sensor, now).inertial_from_sensor = turned;
  } else if (const auto* acceleration = std::get_if<slimevr::Acceleration>(&content)) {
    const auto orientation = tracker.latest.find(acceleration->sensor);
    if (orientation != tracker.latest.end())
      reading_of(tracker, acceleration->sensor, now).free_acceleration =
          orientation->second * acceleration->in_tracker;
  } else if (const auto* battery = std::get_if<slimevr::Battery>(&content)) {
    tracker.battery = std::clamp(battery->charge, 0.0, 1.0);
  } else if (std::holds_alternative<slimevr::MagnetometerAccuracy>(content)) {
    tracker.magnetic = inertial::MagneticState::Unknown;
  } else if (const auto* state = std::get_if<slimevr::SensorState>(&content)) {
    return slimevr::sensor_answer(*state);
  }
  return std::nullopt;
}

std::vector<Outgoing> SlimevrDesk::hear(const std::string& from, std::string_view datagram,
                                        Timestamp now) {
  const auto packets = slimevr::parse(datagram);
  if (!packets) return refuse(from + ": " + to_string(packets.error())), std::vector<Outgoing>{};
  std::vector<Outgoing> answers;
  for (const slimevr::Packet& packet : *packets) {
    if (const auto* handshake = std::get_if<slimevr::Handshake>(&packet.content)) {
      if (trackers_.size() >= kMostTrackers && !trackers_.contains(from)) {
        refuse("there are " + std::to_string(kMostTrackers) + " trackers already");
        continue;
      }
      greet(from, *handshake, now);
      answers.push_back({from, slimevr::handshake_answer()});
      continue;
    }
    const auto tracker = trackers_.find(from);
    if (tracker == trackers_.end()) {
      refuse(from + " has not shaken hands");
      continue;
    }
    if (!advances(tracker->second.number, packet.number)) {
      refuse(tracker->second.name + " repeats packet " + std::to_string(packet.number));
      continue;
    }
    tracker->second.heard = now;
    if (auto answer = take(tracker->second, packet.content, now))
      answers.push_back({from, std::move(*answer)});
  }
  return answers;
}

std::optional<inertial::InertialFrame> SlimevrDesk::instant(Timestamp now) {
  if (waiting_.empty()) return gather(now);
  inertial::InertialFrame frame = std::move(waiting_.front());
  waiting_.pop_front();
  return frame;
}

std::optional<inertial::InertialFrame> SlimevrDesk::gather(Timestamp now) {
  inertial::InertialFrame frame;
  for (auto& [address, tracker] : trackers_) {
    for (auto& [sensor, reading] : tracker.fresh) {
      if (frame.readings.size() >= inertial::kMaxInertialSensors) break;
      reading.battery = tracker.battery;
      reading.magnetic = tracker.magnetic;
      frame.readings.push_back(std::move(reading));
    }
    tracker.fresh.clear();
  }
  if (frame.readings.empty()) return std::nullopt;
  frame.sequence = ++instants_;
  frame.captured = now;
  return frame;
}

std::vector<Outgoing> SlimevrDesk::heartbeats(Timestamp now) {
  std::vector<Outgoing> out;
  if (beaten_ && now - *beaten_ < kHeartbeat && now >= *beaten_) return out;
  beaten_ = now;
  std::erase_if(trackers_, [&](const auto& one) { return now - one.second.heard > kForgotten; });
  for (const auto& [address, tracker] : trackers_) out.push_back({address, slimevr::heartbeat()});
  return out;
}

}  // namespace chorus::inertial_device
