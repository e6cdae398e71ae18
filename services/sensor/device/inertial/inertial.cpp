#include "services/sensor/device/inertial/inertial.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "common/base/units.h"
#include "common/inertial/mocopi.h"
#include "common/inertial/neuron_bvh.h"
#include "common/inertial/rokoko.h"
#include "common/inertial/vmc.h"
#include "common/synthetic/simulated_suit.h"
#include "services/sensor/device/inertial/inertial_feed.h"
#include "services/sensor/device/inertial/mxtp_orientations.h"
#include "services/sensor/device/simulated/scene_settings.h"

namespace chorus::inertial_device {
namespace {

using synthetic::SimulatedSuit;

enum Source : std::size_t {
  kSimulated,
  kReplay,
  kSlimevr,
  kMocopi,
  kVmc,
  kVrchat,
  kRokoko,
  kNeuron,
  kMxtp
};
const std::vector<std::string_view> kSourceNames{"simulated", "replay", "slimevr", "mocopi", "vmc",
                                                 "vrchat",    "rokoko", "neuron",  "mxtp"};
/// Where each source is expected by its makers; 0: no network.
constexpr std::array<std::uint16_t, 9> kUsualPorts{0,    0,     6969, 12351, 39539,
                                                   9000, 14043, 7001, 9763};

struct Settings {
  std::size_t source = kSimulated;
  ReplayedSuit replay;
  SimulatedSuit simulated;
  std::string address = "0.0.0.0";  ///< To listen on.
  std::string host = "127.0.0.1";   ///< To connect to.
  std::uint16_t port = 0;
  std::string actor;
  int person = 0;
};

constexpr Duration kLongest = std::chrono::hours(24);

void read_limb(ConfigReader& section, std::string_view key, inertial::Limb& out) {
  std::string name;
  section.read(key, name);
  if (const auto named = inertial::limb_named(name))
    out = *named;
  else
    section.complain(key, "names no limb; \"ForearmLeft\" would be one");
}

/// One of device.inertial.faults.
synthetic::SuitFault read_fault(ConfigReader& section) {
  using Kind = synthetic::SuitFault::Kind;
  synthetic::SuitFault out;
  std::size_t kind = 0;
  Duration lasts = Duration::max();
  section.read_choice("kind", kind, {"slip", "disturbance", "silence", "battery", "swap", "lie"});
  out.kind = static_cast<Kind>(kind);
  read_limb(section, "limb", out.limb);
  if (out.kind == Kind::Swap) read_limb(section, "other", out.other);
  section.read_s("begin_s", out.begin, Duration{0}, kLongest);
  if (section.has("lasts_s")) section.read_s("lasts_s", lasts, Duration{0}, kLongest);
  if (lasts != Duration::max()) out.end = out.begin + lasts;
  if (out.kind == Kind::Lie)
    section.read("factor", out.size, 1e-3, 1e3);
  else
    section.read_deg("size_deg", out.size, -180.0, 180.0);
  return out;
}

/// The keys of the commonest one, a slip about the limb's axis.
void read_slip(ConfigReader& section, SimulatedSuit& out) {
  std::string limb = "none";
  synthetic::SuitFault slip;
  slip.begin = std::chrono::seconds(20);
  slip.size = deg(60.0);
  section.read("slips", limb);
  section.read_s("slips_after_s", slip.begin, Duration{0}, kLongest);
  section.read_deg("slips_by_deg", slip.size, -180.0, 180.0);
  bool across = false;
  section.read("slips_across", across);
  if (across) slip.axis = Eigen::Vector3d::UnitX();
  if (limb == "none") return;
  read_limb(section, "slips", slip.limb);
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
  for (ConfigReader& fault : section.items("faults")) out.faults.push_back(read_fault(fault));
  read_slip(section, out);
}

Settings read_settings(ConfigReader& section, const SensorId& sensor) {
  Settings out;
  section.read_choice("source", out.source, kSourceNames);
  out.replay.source = sensor;
  section.read("recording", out.replay.recording);
  section.read("loop", out.replay.loop);
  section.read("speed", out.replay.speed, 0.01, 100.0);
  int port = 0;
  section.read("address", out.address);
  section.read("host", out.host);
  section.read("port", port, 0, 65535);
  section.read("actor", out.actor);
  section.read("person", out.person, 0, 255);
  out.port = port == 0 ? kUsualPorts.at(out.source) : static_cast<std::uint16_t>(port);
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

LiveStream stream_of(const Settings& settings) {
  LiveStream out;
  out.connects = settings.source == kNeuron;
  out.address = out.connects ? settings.host : settings.address;
  out.port = settings.port;
  switch (settings.source) {
    case kMocopi:
      out.name = "Sony mocopi";
      out.reader = inertial::make_mocopi_reader();
      break;
    case kVmc:
      out.name = "VMC";
      out.reader = inertial::make_vmc_reader();
      break;
    case kVrchat:
      out.name = "VRChat OSC trackers";
      out.reader = inertial::make_vrchat_reader();
      break;
    case kRokoko:
      out.name = "Rokoko Studio";
      out.reader = inertial::make_rokoko_reader(settings.actor);
      break;
    case kNeuron:
      out.name = "Perception Neuron";
      out.reader = inertial::make_neuron_reader(settings.person);
      break;
    default:
      out.name = "Xsens MVN";
      out.reader = make_mxtp_reader(settings.person);
  }
  return out;
}

Result<std::unique_ptr<InertialFeed>> make_feed(const Settings& settings,
                                                const sensor_service::HostTime& time) {
  if (settings.source == kReplay && settings.replay.recording.empty())
    return fail(ErrorCode::InvalidArgument, "device.inertial.recording",
                "name the recording to replay, a .mcap file");
  if (settings.source == kSlimevr)
    return make_slimevr_feed({settings.address, settings.port}, time);
  if (settings.source == kReplay) return open_replayed_suit(settings.replay, time);
  if (settings.source != kSimulated) return make_stream_feed(stream_of(settings), time);
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
