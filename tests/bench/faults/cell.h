// A small tracker of real processes: chorus-sensors feed one chorus-fusion, all on loopback.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/http/client.h"
#include "common/time/timestamp.h"
#include "tests/bench/faults/link.h"
#include "tests/bench/faults/lossy_path.h"
#include "tests/bench/live/child_process.h"
#include "tests/bench/live/scratch_folder.h"

namespace chorus::bench {

using Settings = std::vector<std::string>;  ///< "key=value"

/// A sensor played by the test and polled like the others.
struct Neighbour {
  std::string id;
  std::uint16_t port = 0;
  int place = -1;  ///< Its place on the ring, after those of the sensors; -1: it is not registered.
  bool honest = true;  ///< Expected to contribute.
};

struct CellPlan {
  int sensors = 3;
  std::vector<Neighbour> neighbours = {};
  int ring = 0;  ///< Number of places on the ring; 0: one per sensor and neighbour.
  std::map<int, Settings> of_sensor = {};
  std::map<int, LinkModel> links = {};   ///< Links in front of these sensors.
  std::optional<PacketModel> path = {};  ///< Network between all sensors and the server.
  Settings fusion = {};
  bool secure = false;                  ///< The server asks the sensors by https.
  ChildSurroundings surroundings = {};  ///< What chorus-fusion starts with.
  /// True: extrinsics are configured; false: the sensors have to be registered.
  bool placed = true;
  /// The extrinsics are in the server's state folder, not in registration.file.
  bool stored = false;
  bool start_all = true;              ///< False: neither a sensor nor the server is started yet.
  std::string address = "127.0.0.1";  ///< Where chorus-fusion listens.
};

class Cell {
 public:
  /// Starts a cell.  Unless the plan says otherwise, every placed sensor contributes when this
  /// returns.
  [[nodiscard]] static Result<Cell> start(CellPlan plan);

  [[nodiscard]] Result<void> start_sensor(int index);
  /// Changes the settings with which the sensor is started the next time.
  void change_sensor(int index, Settings settings) { plan_.of_sensor[index] = std::move(settings); }
  [[nodiscard]] Result<void> start_fusion();
  /// Waits until every placed sensor contributes to one body.
  [[nodiscard]] Result<void> settle() const;

  [[nodiscard]] ChildProcess& fusion() { return *fusion_; }
  [[nodiscard]] ChildProcess& sensor(int index) {
    return *sensors_.at(static_cast<std::size_t>(index));
  }
  [[nodiscard]] Pump& link(int index) { return *links_.at(index); }
  [[nodiscard]] LossyPath& path() { return *path_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::uint16_t sensor_port(int index) const {
    return sensor_ports_.at(static_cast<std::size_t>(index));
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  /// The value of the server's setting "sensors", JSON.
  [[nodiscard]] std::string polled() const;
  /// s1, s2, ... and the honest neighbours that have a place.
  [[nodiscard]] std::vector<std::string> placed() const;

  /// Sends one request to chorus-fusion; status 0: no answer.
  [[nodiscard]] http::ClientResponse ask(http::ClientRequest request) const;
  /// The answer to a GET as JSON; discarded() if there is none.
  [[nodiscard]] nlohmann::json json(const std::string& path) const;
  /// What /sensors/ reports about this sensor.
  [[nodiscard]] nlohmann::json told_of(const std::string& sensor) const;

 private:
  Cell(CellPlan plan, ScratchFolder folder) : plan_(std::move(plan)), folder_(std::move(folder)) {}
  [[nodiscard]] Result<void> take_ports();
  [[nodiscard]] Result<void> lead_through_path(int index);
  std::string write_places() const;

  CellPlan plan_;
  ScratchFolder folder_;  // destroyed last
  std::uint16_t port_ = 0;
  std::vector<std::uint16_t> sensor_ports_;
  std::unique_ptr<LossyPath> path_;
  std::vector<std::unique_ptr<Pump>> far_ends_;
  std::map<int, std::unique_ptr<Pump>> links_;
  std::vector<std::optional<ChildProcess>> sensors_;
  std::optional<ChildProcess> fusion_;
};

/// The arguments of a program with this configuration file and settings.
[[nodiscard]] std::vector<std::string> words_of(const std::string& config,
                                                const Settings& settings);

/// Sends a GET or another request to any port of this host.
[[nodiscard]] http::ClientResponse ask_port(std::uint16_t port, http::ClientRequest request);

/// Waits until `holds()` is true; false if it does not hold within `patience` [s].
[[nodiscard]] bool wait_until(double patience, const std::function<bool()>& holds);

void wait_for(double duration);  ///< [s]

[[nodiscard]] Timestamp now();

}  // namespace chorus::bench
