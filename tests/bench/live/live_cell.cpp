#include "tests/bench/live/live_cell.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/http/client.h"
#include "common/http/server.h"
#include "common/resource/frame_resource.h"
#include "common/resource/link_lines.h"
#include "tests/support/builders.h"
#include "tests/support/free_port.h"
#include "tests/support/vrpn/vrpn_client.h"

namespace chorus::bench {
namespace {

using std::chrono::milliseconds;

constexpr double kRate = 30.0;  // [Hz]
constexpr Duration kInterval{33'333'333};
constexpr double kRadius = 3.0;  // [m]
constexpr double kHeight = 1.4;  // [m]
constexpr std::size_t kKept = 90;
constexpr auto kPatience = std::chrono::seconds(30);

/// People who sway as real ones do: coordinates that never change are refused as implausible.
std::vector<Skeleton<WorldSpace>> people(int count, Timestamp now) {
  constexpr double kSway = 0.005;                   // [m]
  constexpr std::int64_t kSwaying = 4'000'000'000;  // [ns]
  const double turn = deg(360.0) * static_cast<double>(to_unix_ns(now) % kSwaying) / kSwaying;
  std::vector<Skeleton<WorldSpace>> out;
  for (int i = 0; i < count; ++i) {  // three in a row, two rows, 0.9 m apart
    const double x = 0.9 * (i % 3 - 1) + kSway * std::sin(turn);
    const double z = 0.9 * static_cast<double>(i / 3) - 0.45;
    out.push_back(testing::standing_person({x, 0, z}, deg(50.0 * i)));
  }
  return out;
}

struct Received {
  Timestamp instant;
  Timestamp when;
};

/// Receives frames with one VRPN client, alone on this thread; returns the time of each receipt.
std::vector<Received> receive_frames(testing::VrpnClient& client, double run_seconds) {
  std::vector<Received> out;
  const SystemClock clock;
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::nanoseconds(from_seconds(run_seconds));
  while (std::chrono::steady_clock::now() < end) {
    const auto message = client.next("vrpn_Tracker Pos_Quat", milliseconds(200));
    if (message) out.push_back({from_unix_ns(message->time_us * 1000), clock.now()});
  }
  return out;
}

/// Number of bodies in /frame at present.
int bodies_now(const LiveCell& cell) {
  const auto answer = http::fetch({"127.0.0.1", cell.port, "/frame"},
                                  {"GET", "/frame", {{"Accept", "application/json"}}, {}});
  int bodies = 0;
  if (!answer) return bodies;
  constexpr std::string_view kBody = "\"bodyId\"";
  for (auto at = answer->body.find(kBody); at != std::string::npos;
       at = answer->body.find(kBody, at + 1))
    ++bodies;
  return bodies;
}

}  // namespace

struct ExactSensors::Sensor {
  Sensor(int index, int count)
      : id("s" + std::to_string(index + 1)),
        world_from_sensor(testing::ring_sensor(index, count, kRadius, kHeight)),
        due(index * kInterval / count) {}

  void publish(int persons, Timestamp now) {
    std::vector<BodyFrame> bodies;
    for (const auto& person : people(persons, now)) {
      bodies.push_back(testing::body_seen_from(world_from_sensor, person, now, bodies.size() + 1));
    }
    SensorFrame frame = testing::sensor_frame(id, now, std::move(bodies));
    const auto shared =
        std::make_shared<const resource::FrameResource>(resource::to_resource(frame));
    http::DocumentOptions options;
    options.version = std::to_string(++sequence);
    std::vector<http::Variant> variants;
    variants.push_back(
        {"text/turtle", [shared] { return write(*shared, resource::Format::Turtle); }});
    document->publish(std::make_shared<const http::Document>(std::move(variants), options));
  }

  std::string id;
  Eigen::Isometry3d world_from_sensor;
  Duration due;  ///< Time of the next capture, since the beginning.
  std::uint64_t sequence = 0;
  std::shared_ptr<http::LiveDocument> document = std::make_shared<http::LiveDocument>();
  std::unique_ptr<http::Server> server;
  std::deque<Timestamp> captures;
};

ExactSensors::ExactSensors(int count, int persons) : persons_(persons) {
  for (int i = 0; i < count; ++i) {
    auto sensor = std::make_unique<Sensor>(i, count);
    auto router = std::make_shared<http::Router>();
    router->live("/frame", sensor->document);
    sensor->server = std::make_unique<http::Server>(
        http::ServerConfig{.policy = resource::answer_policy()}, router);
    if (!sensor->server->start()) std::abort();  // loopback, any port
    sensors_.push_back(std::move(sensor));
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

ExactSensors::~ExactSensors() {
  thread_.request_stop();
  thread_.join();
}

void ExactSensors::run(const std::stop_token& stop) {
  const SystemClock clock;
  const auto begun = std::chrono::steady_clock::now();
  while (!stop.stop_requested()) {
    auto next = std::min_element(sensors_.begin(), sensors_.end(),
                                 [](const auto& a, const auto& b) { return a->due < b->due; });
    std::this_thread::sleep_until(begun + std::chrono::nanoseconds((*next)->due));
    const Timestamp now = clock.now();
    {
      const std::scoped_lock lock(mutex_);
      (*next)->captures.push_back(now);
      if ((*next)->captures.size() > kKept) (*next)->captures.pop_front();
    }
    (*next)->publish(persons_, now);
    (*next)->due += kInterval;
  }
}

std::string ExactSensors::settings() const {
  std::string list;
  for (const auto& sensor : sensors_) {
    list += fmt::format(R"({}{{"id":"{}","url":"http://127.0.0.1:{}/"}})", list.empty() ? "" : ",",
                        sensor->id, sensor->server->port());
  }
  return "[" + list + "]";
}

std::string ExactSensors::places() const {
  std::string list;
  for (const auto& sensor : sensors_) {
    const Eigen::Vector3d p = sensor->world_from_sensor.translation();
    const Eigen::Quaterniond q(sensor->world_from_sensor.linear());
    list += fmt::format(R"({}"{}":{{"x":{},"y":{},"z":{},"qx":{},"qy":{},"qz":{},"qw":{}}})",
                        list.empty() ? "" : ",", sensor->id, p.x(), p.y(), p.z(), q.x(), q.y(),
                        q.z(), q.w());
  }
  return "{\"sensors\":{" + list + "}}";
}

std::optional<Timestamp> ExactSensors::last_needed_capture(Timestamp instant) const {
  const std::scoped_lock lock(mutex_);
  std::optional<Timestamp> last;
  for (const auto& sensor : sensors_) {
    const auto& captures = sensor->captures;
    const auto first =
        std::find_if(captures.begin(), captures.end(), [&](Timestamp t) { return t >= instant; });
    if (first == captures.end() || first == captures.begin()) return std::nullopt;
    if (!last || *first > *last) last = *first;
  }
  return last;
}

Result<LiveCell> start_cell(int sensors, int persons, const std::vector<std::string>& settings) {
  auto folder = ScratchFolder::make();
  if (!folder) return pass(folder);
  LiveCell cell{std::make_unique<ExactSensors>(sensors, persons),
                std::move(*folder),
                {},
                testing::free_port(),
                testing::free_port()};
  const std::string places = (cell.folder.path() / "places.json").string();
  std::ofstream(places) << cell.sensors->places();
  std::vector<std::string> words{"--config", "deploy/config/fusion.json",
                                 "--set",    "http.port=" + std::to_string(cell.port),
                                 "--set",    "sensors=" + cell.sensors->settings(),
                                 "--set",    "viewer_dir=",
                                 "--set",    "state_dir=",
                                 "--set",    "registration.file=" + places,
                                 "--set",    "outputs.vrpn.enabled=true",
                                 "--set",    "outputs.vrpn.port=" + std::to_string(cell.vrpn_port)};
  for (const std::string& each : settings) words.insert(words.end(), {"--set", each});
  auto fusion = ChildProcess::start("chorus-fusion", words);
  if (!fusion) return pass(fusion);
  cell.fusion.push_back(std::move(*fusion));
  const auto begun = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - begun < kPatience) {
    std::this_thread::sleep_for(milliseconds(200));
    if (bodies_now(cell) == persons) return cell;
  }
  return fail(ErrorCode::Timeout, "chorus-fusion",
              "the people were not all fused in half a minute");
}

Result<Lateness> watch(const LiveCell& cell, double run_seconds) {
  testing::VrpnClient client({"Body0_Neck"});
  if (!client.request(cell.vrpn_port)) {
    return fail(ErrorCode::Io, "vrpn", "the server cannot be reached");
  }
  Lateness out;
  std::vector<Received> frames;
  constexpr double kPart = 1.0;  // the sensors remember only three seconds of captures
  for (double done = 0.0; done < run_seconds; done += kPart) {
    for (const Received& frame : receive_frames(client, kPart)) {
      frames.push_back(frame);
      const auto needed = cell.sensors->last_needed_capture(frame.instant);
      if (needed) out.beyond_capture.push_back(seconds(frame.when - *needed));
    }
  }
  if (frames.size() < 2) return fail(ErrorCode::Internal, "vrpn", "no frames came");
  const double span = seconds(frames.back().when - frames.front().when);
  out.output_hz = static_cast<double>(frames.size() - 1) / span;
  const double instants = seconds(frames.back().instant - frames.front().instant) * kRate;
  out.lost = static_cast<std::size_t>(std::llround(instants)) + 1 - frames.size();
  return out;
}

}  // namespace chorus::bench
