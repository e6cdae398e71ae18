// The part of Program that all services share: turns settings into a running service.
//
// Settings have two parts, each compared by value (defaulted ==).  A reload applies the whole part
// `live`. The part `at_start` needs a restart; a reload logs which of its keys have changed.  No
// key is listed by hand, so none can be forgotten.
#pragma once

#include <memory>
#include <utility>

#include "common/base/log.h"
#include "common/service/program.h"
#include "common/service/waiting_keys.h"
#include "common/time/clock.h"

namespace chorus::service {

/// `Settings` has a member `live`, which has a LogConfig `log`, and a member `at_start`.
/// `Host` has: static Result<std::unique_ptr<Host>> make(const Settings&), which binds no port;
///   Result<void> start(); void take(const live part&); void stop();
///   and optionally: bool alive(); Concerns concerns();
///   void tell_of(std::shared_ptr<const Configuration>), called after make().
template <class Settings, class Host>
class HostedProgram final : public Program {
 public:
  /// Reads all keys and calls ConfigReader::finish().
  using Read = Result<Settings> (*)(ConfigReader);
  explicit HostedProgram(Read read) : read_(read) {}

  [[nodiscard]] Result<LogConfig> prepare(ConfigReader config) override {
    started_as_ = config.text();
    auto settings = read_(std::move(config));
    if (!settings) return pass(settings);
    auto host = Host::make(*settings);
    if (!host) return pass(host);
    settings_ = std::move(*settings);
    host_ = std::move(*host);
    if constexpr (requires(Host & h) { h.tell_of(configuration()); })
      host_->tell_of(configuration());
    return settings_.live.log;
  }

  [[nodiscard]] std::vector<std::string> concerns() override {
    if constexpr (requires(Host & host) { host.concerns(); }) return host_->concerns();
    return {};
  }

  [[nodiscard]] Result<void> start() override { return host_->start(); }

  [[nodiscard]] Result<LogConfig> reload(ConfigReader config) override {
    const std::string text = config.text();
    const auto wanted = read_(std::move(config));
    if (!wanted) return pass(wanted);
    const auto keys = needs_restart(*wanted) ? waiting(text) : std::vector<std::string>{};
    std::string all;
    for (const std::string& key : keys) all += (all.empty() ? "" : ", ") + key;
    if (!keys.empty()) log::warn("changes wait for a restart", {{"keys", all}});
    settings_.live = wanted->live;
    host_->take(settings_.live);
    configuration()->reloaded(text, keys, SystemClock().now());
    return settings_.live.log;
  }

  void stop() override { host_->stop(); }

  [[nodiscard]] bool alive() override {
    if constexpr (requires(Host & host) { host.alive(); }) return host_->alive();
    return true;
  }

 private:
  [[nodiscard]] bool needs_restart(const Settings& wanted) const {
    return !(wanted.at_start == settings_.at_start);
  }

  /// The changed keys that need a restart.  A key that is not valid when changed alone counts as
  /// one.
  [[nodiscard]] std::vector<std::string> waiting(const std::string& wanted) const {
    return waiting_keys(started_as_, wanted, [this](const std::string& text) {
      const auto probe = ConfigReader::parse(text, "reload").and_then(read_);
      return !probe || needs_restart(*probe);
    });
  }

  Read read_;
  Settings settings_;
  std::string started_as_;  ///< The configuration at the start, as JSON.
  std::unique_ptr<Host> host_;
};

/// The complete main() of a service.
template <class Settings, class Host>
[[nodiscard]] int run_service(const About& about, Result<Settings> (*read)(ConfigReader), int argc,
                              const char* const* argv) {
  HostedProgram<Settings, Host> program(read);
  return run_program(about, program, argc, argv);
}

}  // namespace chorus::service
