#include "tests/bench/faults/cell.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <thread>

#include <fmt/format.h>

#include "common/time/clock.h"
#include "tests/bench/faults/guest.h"
#include "tests/bench/faults/watch.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

constexpr double kStartPatience = 15.0;  // for start-up on a busy machine [s]

std::string name_of_sensor(int index) { return fmt::format("s{}", index + 1); }

Result<void> unanswered(const ChildProcess& program, const std::string& name) {
  if (program.alive()) return fail(ErrorCode::Timeout, name, "it does not answer");
  return fail(
      ErrorCode::Io, name,
      "it ended as soon as it was started; this says why, in the project's folder: " + name +
          " --check --config deploy/config/" + name.substr(name.find('-') + 1) + ".json");
}

nlohmann::json place_json(const Eigen::Isometry3d& world_from_sensor) {
  const Eigen::Vector3d p = world_from_sensor.translation();
  const Eigen::Quaterniond q(world_from_sensor.linear());
  return {{"x", p.x()},  {"y", p.y()},  {"z", p.z()}, {"qx", q.x()},
          {"qy", q.y()}, {"qz", q.z()}, {"qw", q.w()}};
}

}  // namespace

Timestamp now() { return SystemClock().now(); }

void wait_for(double duration) { std::this_thread::sleep_for(from_seconds(duration)); }

bool wait_until(double patience, const std::function<bool()>& holds) {
  const auto begun = std::chrono::steady_clock::now();
  while (!holds()) {
    if (std::chrono::steady_clock::now() - begun > from_seconds(patience)) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

std::vector<std::string> words_of(const std::string& config, const Settings& settings) {
  std::vector<std::string> words{"--config", config};
  for (const std::string& each : settings) words.insert(words.end(), {"--set", each});
  return words;
}

http::ClientResponse ask_port(std::uint16_t port, http::ClientRequest request) {
  const std::string target = request.target;
  auto answer = http::fetch({"127.0.0.1", port, target}, request);
  return answer ? std::move(*answer) : http::ClientResponse{};
}

http::ClientResponse Cell::ask(http::ClientRequest request) const {
  return ask_port(port_, std::move(request));
}

nlohmann::json Cell::json(const std::string& path) const {
  const auto answer = ask({"GET", path, {{"Accept", "application/json"}}, {}});
  return nlohmann::json::parse(answer.body, nullptr, /*allow_exceptions=*/false);
}

nlohmann::json Cell::told_of(const std::string& sensor) const { return json("/sensors/" + sensor); }

std::vector<std::string> Cell::placed() const {
  std::vector<std::string> out;
  for (int i = 0; i < plan_.sensors; ++i) out.push_back(name_of_sensor(i));
  for (const Neighbour& each : plan_.neighbours) {
    if (each.place >= 0 && each.honest) out.push_back(each.id);
  }
  return out;
}

Result<void> Cell::take_ports() {
  port_ = testing::free_port();
  if (plan_.path) {
    auto opened = LossyPath::open(*plan_.path);
    if (!opened) return pass(opened);
    path_ = std::move(*opened);
  }
  for (int i = 0; i < plan_.sensors; ++i) {
    sensor_ports_.push_back(testing::free_port());
    sensors_.emplace_back();
    if (const auto it = plan_.links.find(i); it != plan_.links.end())
      links_[i] = std::make_unique<Pump>(on_loopback(sensor_ports_.back()), it->second,
                                         static_cast<std::uint32_t>(i + 1));
    if (!path_) continue;
    if (auto led = lead_through_path(i); !led) return led;
  }
  return {};
}

/// Connects server and sensor through two pumps, one at each end of the lossy path; these pumps add
/// no delay.
Result<void> Cell::lead_through_path(int index) {
  std::uint16_t port = 0;
  Result<void> listens;
  PumpEnds far = on_loopback(sensor_port(index));
  far.listen = [&](asio::io_context& io) {
    auto acceptor = path_->listen_far(io);
    if (acceptor) port = acceptor->local_endpoint().port();
    if (!acceptor) listens = pass(acceptor);
    return acceptor ? std::move(*acceptor) : net::Acceptor(io);
  };
  far_ends_.push_back(std::make_unique<Pump>(std::move(far), LinkModel{}));
  if (!listens) return listens;
  PumpEnds near = on_loopback(port);
  near.socket = [path = path_.get()](asio::io_context& io) {
    auto socket = path->near_socket(io);
    return socket ? std::move(*socket) : net::Socket(io);
  };
  near.target.address(LossyPath::far_address());
  links_[index] = std::make_unique<Pump>(std::move(near), LinkModel{});
  return {};
}

std::string Cell::write_places() const {
  nlohmann::json places = nlohmann::json::object();
  for (int i = 0; i < plan_.sensors; ++i)
    places[name_of_sensor(i)] = place_json(place_of(i, plan_.ring));
  for (const Neighbour& each : plan_.neighbours) {
    if (each.place >= 0) places[each.id] = place_json(place_of(each.place, plan_.ring));
  }
  std::error_code ignored;
  const auto state = folder() / "state";
  std::filesystem::create_directory(state, ignored);
  const std::string path = (state / "registration.json").string();
  std::ofstream(path) << nlohmann::json{{"sensors", places}};
  return path;
}

std::string Cell::polled() const {
  nlohmann::json list = nlohmann::json::array();
  const auto add = [&](const std::string& id, std::uint16_t port) {
    const char* const scheme = plan_.secure ? "https" : "http";
    list.push_back({{"id", id}, {"url", fmt::format("{}://127.0.0.1:{}/", scheme, port)}});
  };
  for (int i = 0; i < plan_.sensors; ++i) {
    const auto link = links_.find(i);
    add(name_of_sensor(i), link == links_.end() ? sensor_port(i) : link->second->port());
  }
  for (const Neighbour& each : plan_.neighbours) add(each.id, each.port);
  return list.dump();
}

Result<void> Cell::start_sensor(int index) {
  Settings settings{"id=" + name_of_sensor(index),
                    fmt::format("http.port={}", sensor_port(index)),
                    "device.kind=simulated",
                    "device.simulated.scene.reach_m=0.5",
                    fmt::format("device.simulated.ring.index={}", index),
                    fmt::format("device.simulated.ring.count={}", plan_.ring)};
  if (const auto it = plan_.of_sensor.find(index); it != plan_.of_sensor.end())
    settings.insert(settings.end(), it->second.begin(), it->second.end());
  auto started =
      ChildProcess::start("chorus-sensor", words_of("deploy/config/sensor.json", settings));
  if (!started) return pass(started);
  sensors_.at(static_cast<std::size_t>(index)).emplace(std::move(*started));
  const auto answers = [&] { return ask_port(sensor_port(index), {"GET", "/frame"}).status != 0; };
  if (wait_until(kStartPatience, [&] { return answers() || !sensor(index).alive(); }) &&
      sensor(index).alive())
    return {};
  return unanswered(sensor(index), "chorus-sensor");
}

Result<void> Cell::start_fusion() {
  Settings settings{"http.address=" + plan_.address,
                    fmt::format("http.port={}", port_),
                    "sensors=" + polled(),
                    "viewer_dir=",
                    "state_dir=",
                    "output.history_s=60"};
  const bool again = fusion_.has_value();
  if (plan_.stored) {
    if (!again) write_places();
    settings.push_back("state_dir=" + (folder() / "state").string());
  } else if (plan_.placed) {
    settings.push_back("registration.file=" + write_places());
  }
  settings.insert(settings.end(), plan_.fusion.begin(), plan_.fusion.end());
  fusion_.reset();
  auto started = ChildProcess::start(
      "chorus-fusion", words_of("deploy/config/fusion.json", settings), plan_.surroundings);
  if (!started) return pass(started);
  fusion_.emplace(std::move(*started));
  const auto answers = [&] { return ask({"GET", "/healthz"}).status != 0; };
  if (wait_until(kStartPatience, [&] { return answers() || !fusion_->alive(); }) &&
      fusion_->alive())
    return {};
  return unanswered(*fusion_, "chorus-fusion");
}

Result<void> Cell::settle() const {
  const Watch watch(port_);
  const auto wanted = placed();
  const auto all_here = [&] {
    const FusedInstant newest = watch.newest();
    return newest.bodies.size() == 1 && std::ranges::all_of(wanted, [&](const std::string& name) {
             return newest.contributors.contains(name);
           });
  };
  if (wait_until(kStartPatience, all_here)) return {};
  return fail(ErrorCode::Timeout, "the cell",
              "not every sensor contributed to one person within 15 s, before anything was done");
}

Result<Cell> Cell::start(CellPlan plan) {
  auto folder = ScratchFolder::make();
  if (!folder) return pass(folder);
  const auto all = plan.sensors + static_cast<int>(plan.neighbours.size());
  if (plan.ring == 0) plan.ring = all;
  Cell cell(std::move(plan), std::move(*folder));
  if (auto taken = cell.take_ports(); !taken) return pass(taken);
  if (!cell.plan_.start_all) return cell;
  for (int i = 0; i < cell.plan_.sensors; ++i) {
    if (auto started = cell.start_sensor(i); !started) return pass(started);
  }
  if (auto started = cell.start_fusion(); !started) return pass(started);
  if (!cell.plan_.placed) return cell;
  if (auto settled = cell.settle(); !settled) return pass(settled);
  return cell;
}

}  // namespace chorus::bench
