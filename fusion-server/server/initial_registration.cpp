#include "fusion-server/server/initial_registration.h"

#include <algorithm>
#include <utility>

#include "common/base/log.h"

namespace chorus::server {
namespace {

/// Logs which sensors have no place in the registration, and which of its sensors are not polled.
void report_fit(const Registration& registration, const LiveSettings& live) {
  for (const client::FollowedService& sensor : live.sensors) {
    if (!registration.sensors.contains(sensor.id)) {
      log::warn("sensor has no place in the registration", {{"sensor", sensor.id.str()}});
    }
  }
  for (const auto& [sensor, place] : registration.sensors) {
    if (std::ranges::find(live.sensors, sensor, &client::FollowedService::id) == live.sensors.end())
      log::warn("registration knows a sensor that is not polled", {{"sensor", sensor.str()}});
  }
}

Result<InitialRegistration> stored_registration(const RegistrationStore& store) {
  auto stored = store.load();
  if (!stored) {
    Recovered recovered = store.recover(stored.error());
    log::error("stored registration damaged", {{"what", recovered.told}});
    return InitialRegistration{std::move(recovered.registration).value_or(Registration{}),
                               std::move(recovered.told)};
  }
  if (!*stored) return InitialRegistration{};
  log::info("stored registration in use",
            {{"version", (*stored)->version}, {"sensors", (*stored)->sensors.size()}});
  return InitialRegistration{std::move(**stored), {}};
}

}  // namespace

Result<Registration> given_registration(const std::string& file) {
  auto given = load_registration_file(file);
  if (given) return given;
  return fail(given.error().code, "registration.file", to_string(given.error()));
}

Result<InitialRegistration> initial_registration(const FusionSettings& settings,
                                                 const RegistrationStore& store) {
  const std::string& file = settings.at_start.registration_file;
  auto found = file.empty() ? stored_registration(store)
                            : given_registration(file).map([](Registration given) {
                                return InitialRegistration{std::move(given), {}};
                              });
  if (found && !found->registration.sensors.empty()) report_fit(found->registration, settings.live);
  return found;
}

}  // namespace chorus::server
