#include "services/ctl/calibrate/recorded_places.h"

#include <algorithm>
#include <utility>

#include <CLI/CLI.hpp>

#include "fusion-server/registration/overruled_clocks.h"
#include "fusion-server/server/registration_store.h"

namespace chorus::ctl {
namespace {

/// The extrinsics that lie beside the recordings, as `chorus import` writes them.
Result<Places> places_beside(const std::vector<std::filesystem::path>& files,
                             const RecordedCell& cell) {
  const auto beside = registration_beside(files);
  if (!beside) return pass(beside);
  if (!*beside) return Places{};
  const std::string file = (*beside)->string();
  auto registration = server::load_registration_file(file);
  if (!registration) {
    return fail(registration.error().code, file,
                registration.error().message +
                    "; it lies beside the recordings: name another with --registration, or "
                    "register from the person with --from-walk");
  }
  const auto sensors = cell.sensors();
  if (std::ranges::none_of(
          sensors, [&](const SensorId& sensor) { return registration->sensors.contains(sensor); }))
    return Places{std::nullopt, file + " is of other sensors, and is not used", false};
  return Places{std::move(*registration),
                "the sensors stand where " + file +
                    " says, which lies beside the recordings; --from-walk registers anew"};
}

}  // namespace

void add_place_options(CLI::App& app, PlaceOptions& options) {
  auto* registration = app.add_option(
      "--registration", options.registration,
      "Extrinsics as JSON; without it those of the recording, else registration.json "
      "beside it, else from the person");
  app.add_flag("--from-walk", options.from_walk,
               "Register from the person, though the recording has a registration, in it or "
               "beside it")
      ->excludes(registration);
}

Result<Places> given_places(const PlaceOptions& options,
                            const std::vector<std::filesystem::path>& files,
                            const RecordedCell& cell) {
  if (options.from_walk) return Places{};
  if (!options.registration.empty()) {
    auto registration = server::load_registration_file(options.registration);
    if (!registration) return pass(registration);
    return Places{std::move(*registration), {}};
  }
  auto recorded = cell.registration();
  if (!recorded) return pass(recorded);
  if (*recorded) return Places{std::move(*recorded), {}};
  return places_beside(files, cell);
}

Result<Places> places_of(const PlaceOptions& options,
                         const std::vector<std::filesystem::path>& files, RecordedCell& cell,
                         const pipeline::OfflineConfig& config) {
  auto given = given_places(options, files, cell);
  if (!given || given->registration) return given;
  auto solved = pipeline::register_recordings(cell.input(), config);
  if (!solved) return pass(solved);
  if (registration::claims_overruled(*solved)) cell.drop_clock_claims();
  given->registration = std::move(*solved);
  given->solved = true;
  return given;
}

}  // namespace chorus::ctl
