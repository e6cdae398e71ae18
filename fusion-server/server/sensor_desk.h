// Owns what operators change about the sensors, looks for sensors in the network, and tries
// addresses: everything behind /setup and the writing methods of /sensors/.
#pragma once

#include <functional>
#include <mutex>
#include <string>

#include "fusion-server/rest/setup_resources.h"
#include "fusion-server/server/sensor_changes.h"
#include "fusion-server/server/worker.h"

namespace chorus::server {

struct SensorDeskOptions {
  std::string folder;  ///< The state folder; empty: changes are forgotten at the end.
  std::function<tls::Trust()> trust;     ///< The authorities accepted for https.
  std::function<Services()> configured;  ///< The sensors of the configuration.
  std::function<void()> changed;         ///< Called after each change, to follow other sensors.
  std::string run;                       ///< Of this server, which is no sensor of its own.
};

/// Thread-safe.
class SensorDesk {
 public:
  /// Reads the stored changes; a file that cannot be read is logged, left as it is, and nothing is
  /// written over it.
  explicit SensorDesk(SensorDeskOptions options);

  [[nodiscard]] Services followed(const Services& configured) const;
  /// Functions that use this object, which must outlive them.
  [[nodiscard]] rest::SetupControl control();

 private:
  [[nodiscard]] std::string path() const;
  [[nodiscard]] rest::SetupFacts facts() const;
  /// The changes after the present ones, given the configured sensors.
  using Change = std::function<Result<SensorChanges>(SensorChanges, const Services&)>;
  [[nodiscard]] Result<void> put(const Change& change);
  [[nodiscard]] SensorChanges changes() const;
  void search();
  [[nodiscard]] Result<void> attempt(const client::FollowedService& sensor);
  [[nodiscard]] Result<void> begin_trial(const std::string& url);

  SensorDeskOptions options_;
  mutable std::mutex mutex_;  ///< Guards the members below.
  SensorChanges changes_;
  std::string damage_;  ///< Why the stored file cannot be read; empty if it can.
  rest::SetupFacts told_;
  Worker worker_;  ///< The last member: its jobs use the others.
};

}  // namespace chorus::server
