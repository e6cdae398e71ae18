// Sensors that lie, fail or misbehave, played by this process.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Geometry>

#include "common/http/live_document.h"
#include "common/http/server.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::bench {

/// The person that all sensors of a cell see; walks within half a metre of the middle.
[[nodiscard]] Skeleton<WorldSpace> person_at(Timestamp instant);

/// The same person where the scene says that people exercise.
[[nodiscard]] Skeleton<WorldSpace> exercising_person_at(Timestamp instant);

/// Pose of place `index` of `count` on the ring of simulated sensors.
[[nodiscard]] Eigen::Isometry3d place_of(int index, int count);

/// A sensor that serves what its script returns, at 30 Hz.
class Guest {
 public:
  struct Said {
    Timestamp captured;
    std::vector<BodyFrame> bodies = {};
    /// Additional Turtle, sent after the frame; if it is not empty, only Turtle is served.
    std::string behind = {};
  };
  using Script = std::function<Said(Timestamp now)>;

  Guest(std::string id, Script script);
  ~Guest();
  Guest(const Guest&) = delete;
  Guest& operator=(const Guest&) = delete;

  [[nodiscard]] const std::string& id() const { return id_; }
  [[nodiscard]] std::uint16_t port() const { return server_->port(); }

 private:
  void run(const std::stop_token& stop);
  void say(const Said& said);

  std::string id_;
  Script script_;
  std::uint64_t sequence_ = 0;
  std::shared_ptr<http::LiveDocument> document_ = std::make_shared<http::LiveDocument>();
  std::unique_ptr<http::Server> server_;
  std::jthread thread_;
};

/// What an honest sensor at this place says about the person.
[[nodiscard]] Guest::Said honest(const Eigen::Isometry3d& world_from_sensor, Timestamp now);

/// Accepts connections on a free port and runs a function on each of them, in a
/// thread of its own.  The sockets are shut down and closed when the server is
/// destroyed.
class RawServer {
 public:
  using Conversation = std::function<void(int socket)>;
  explicit RawServer(Conversation conversation);
  ~RawServer();
  RawServer(const RawServer&) = delete;
  RawServer& operator=(const RawServer&) = delete;
  [[nodiscard]] std::uint16_t port() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::bench
