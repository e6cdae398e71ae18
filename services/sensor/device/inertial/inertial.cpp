#include "services/sensor/device/inertial/inertial.h"

#include <algorithm>
#include <string>
#include <utility>

#include "common/base/units.h"
#include "common/synthetic/simulated_suit.h"
#include "services/sensor/device/inertial/inertial_feed.h"
#include "services/sensor/device/simulated/scene_settings.h"

namespace chorus::inertial_device {
namespace {

using synthetic::SimulatedSuit;

enum Source : std::size_t { kSimulated, kReplay, kSlimevr };

struct Settings {
  std::size_t source = kSimulated;
  ReplayedSuit replay;
  SimulatedSuit simulated;
  SlimevrServer slimevr;
};

void read_slip(ConfigReader& section, SimulatedSuit& out) {
  std::string limb = "none";
  synthetic::SuitFault slip;
  slip.begin = std::chrono::seconds(20);
  slip.size = deg(60.0);
  section.read("slips", limb);
  section.read_s("slips_after_s", slip.begin, Duration{0}, std::chrono::hours(24));
  section.read_deg("slips_by_deg", slip.size, -180.0, 180.0);
  if (limb == "none") return;
  const auto named = inertial::limb_named(limb);
  if (!named) return section.complain("slips", "names no limb; \"ForearmLeft\" would be one");
  slip.limb = *named;
  out.faults.push_back(slip);
}

void read_errors(ConfigReader& section, synthetic::SuitErrors& out) {
  section.read_deg("noise_deg", out.noise, 0.0, 30.0);
  section.read_deg("heading_drift_deg_s", out.heading_drift, 0.0, 10.0);
  section.read_deg("bias_walk_deg_s", out.bias_walk, 0.0, 10.0);
  section.read("skin", out.skin, 0.0, 10.0);
}

void read_simulated(ConfigReader& section, SimulatedSuit& out) {
  int sensors = 13;
  int seed = 1;
  out.scene = sensor_service::read_scene(section.child("scene")).scene;
  section.read("sensors", sensors, 5, 13);
  if (sensors > 6 && sensors < 13) section.complain("sensors", "must be 5, 6 or 13");
  section.read("rate_hz", out.rate_hz, 1.0, 1000.0);
  section.read("seed", seed, 0, sensor_service::kMaxSeed);
  section.read("raw", out.raw);
  out.seed = static_cast<std::uint64_t>(seed);
  out.limbs = synthetic::limbs_of_suit(sensors);
  read_errors(section, out.errors);
  read_slip(section, out);
}

Settings read_settings(ConfigReader& section, const SensorId& sensor) {
  Settings out;
  section.read_choice("source", out.source, {"simulated", "replay", "slimevr"});
  out.replay.source = sensor;
  section.read("recording", out.replay.recording);
  section.read("loop", out.replay.loop);
  section.read("speed", out.replay.speed, 0.01, 100.0);
  int port = out.slimevr.port;
  section.read("address", out.slimevr.address);
  section.read("port", port, 1, 65535);
  out.slimevr.port = static_cast<std::uint16_t>(port);
  read_simulated(section, out.simulated);
  return out;
}

/// The simulated suit in true time.
class SimulatedFeed final : public InertialFeed {
 public:
  SimulatedFeed(SimulatedSuit suit, sensor_service::HostTime time)
      : suit_(std::move(suit)), time_(std::move(time)) {}

  [[nodiscard]] std::string label() const override {
    return "simulated suit with " + std::to_string(suit_.limbs.size()) + " sensors";
  }
  [[nodiscard]] double rate_hz() const override { return suit_.rate_hz; }

  [[nodiscard]] Result<void> run(std::stop_token stop, const TakeInstant& take) override {
    constexpr Duration kFarBehind = std::chrono::seconds(1);
    const Timestamp start = time_.world->now();
    const Duration step = from_seconds(1.0 / suit_.rate_hz);
    Timestamp due = start;
    std::uint64_t number = 0;
    while (wait_until(*time_.world, stop, due)) {
      inertial::InertialFrame instant = suit_at(suit_, start, due, ++number);
      instant.captured = time_.host.host_time(due);
      for (auto& reading : instant.readings) reading.captured = instant.captured;
      take(std::move(instant));
      due += step;
      if (time_.world->now() - due > kFarBehind) due = time_.world->now();  // Was suspended.
    }
    return {};
  }

 private:
  SimulatedSuit suit_;
  sensor_service::HostTime time_;
};

class InertialDevice final : public FrameSource {
 public:
  InertialDevice(std::unique_ptr<InertialFeed> feed, SensorId sensor)
      : feed_(std::move(feed)), sensor_(std::move(sensor)) {}

  [[nodiscard]] DeviceDescription describe() const override {
    DeviceDescription about;
    about.kind = "inertial";
    about.label = feed_->label();
    about.depth_camera = std::nullopt;
    about.nominal_rate_hz = feed_->rate_hz();
    about.bodies = false;
    about.orientations = true;
    return about;
  }

  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override {
    return feed_->run(std::move(stop), [&](inertial::InertialFrame instant) {
      instant.source = sensor_;
      sink(std::move(instant));
    });
  }

 private:
  std::unique_ptr<InertialFeed> feed_;
  SensorId sensor_;
};

Result<std::unique_ptr<InertialFeed>> make_feed(const Settings& settings,
                                                const sensor_service::HostTime& time) {
  if (settings.source == kReplay && settings.replay.recording.empty())
    return fail(ErrorCode::InvalidArgument, "device.inertial.recording",
                "name the recording to replay, a .mcap file");
  if (settings.source == kSlimevr) return make_slimevr_feed(settings.slimevr, time);
  if (settings.source == kReplay) return open_replayed_suit(settings.replay, time);
  return std::unique_ptr<InertialFeed>(std::make_unique<SimulatedFeed>(settings.simulated, time));
}

}  // namespace

void check_inertial_settings(ConfigReader& section, const SensorId& sensor) {
  (void)read_settings(section, sensor);
}

Result<std::unique_ptr<FrameSource>> make_inertial(ConfigReader& section,
                                                   const sensor_service::DeviceContext& context) {
  auto feed = make_feed(read_settings(section, context.sensor), context.time);
  if (!feed) return pass(feed);
  return std::make_unique<InertialDevice>(std::move(*feed), context.sensor);
}

}  // namespace chorus::inertial_device
