// What a running service says of its own configuration: what is in force, whether the file has been
// changed since, which changes wait for a restart, and why the last reload failed.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/service/config_source.h"
#include "common/time/timestamp.h"

namespace chorus::service {

/// What can be told to anybody who may read: without secrets and without paths of the host.
struct ConfigurationFacts {
  std::string file;                  ///< Its name, without the folder; empty: there is none.
  std::string in_force;              ///< JSON.
  Timestamp read;                    ///< When what is in force was read.
  std::vector<std::string> waiting;  ///< Keys that were changed and need a restart.
  std::string reload_error;  ///< Why the last reload changed nothing; empty if it was taken.
  std::optional<Timestamp> reloaded;         ///< When the last reload was asked for.
  std::vector<std::string> changed_on_disk;  ///< Keys in which the file differs from what was read.
  std::string disk_error;                    ///< Why the file cannot be read now; empty if it can.
};

/// Thread-safe.  The program's shell notes, the network's thread asks.
class Configuration {
 public:
  /// What the service starts with.
  void started(ConfigSource source, std::string text, Timestamp now);
  void reload_failed(const Error& error, Timestamp now);
  /// A reload was taken, except for these keys.
  void reloaded(std::string text, std::vector<std::string> waiting, Timestamp now);

  /// Reads the file, unless that was done less than a second ago; one that is no regular file is
  /// read only at start and on reload.
  [[nodiscard]] ConfigurationFacts facts() const;

  /// What is amiss, in a sentence with what to do; empty if nothing is.
  [[nodiscard]] std::string trouble() const;

 private:
  void look_at_disk() const;  ///< Call it with the mutex held.

  mutable std::mutex mutex_;
  ConfigSource source_;
  std::string text_;  ///< As last read and taken, JSON.
  std::string started_as_;
  std::vector<std::string> waiting_;
  std::string reload_error_;
  Timestamp read_{};
  std::optional<Timestamp> reloaded_;
  struct Disk {
    std::filesystem::file_time_type modified;
    std::vector<std::string> changed;
    std::string error;
  };
  mutable std::optional<Disk> disk_;
};

/// The JSON without secrets (tokens, passwords, what follows "user:" in a URL) and without paths of
/// the host.
[[nodiscard]] std::string without_secrets(const std::string& json);

/// The resource /configuration.
[[nodiscard]] std::string configuration_json(const ConfigurationFacts& facts);

}  // namespace chorus::service
