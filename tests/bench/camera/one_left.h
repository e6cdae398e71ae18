// What is measured of a person whom one camera of several sees for a while.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fusion-server/flow/registration.h"
#include "fusion-server/registration/registration.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

/// One person before several cameras, and the truth at every instant of `rate_hz`.
struct LeftTake {
  std::string name;
  std::vector<registration::WalkTrack> tracks;
  Registration places;
  std::vector<Skeleton<WorldSpace>> truth;
  double rate_hz = 30.0;
};

/// When all cameras but one lose the person: for `lasts` [s], again and again from `first` on,
/// `every` [s]; another camera is left each time.
struct Withholding {
  double first = 4.0;
  double every = 4.0;
  double lasts = 2.0;
  std::optional<std::size_t> only = {};  ///< This camera is left each time.
};

/// Adds the rows of a take as shipped, with one camera left at times and with all of them.
[[nodiscard]] Result<void> measure_left(Report& report, const LeftTake& take,
                                        const Withholding& when);

/// A person who walks between four simulated cameras; `points`: of guessed depth, otherwise rays.
/// `among_depth`: all but the last one measure depth.
[[nodiscard]] LeftTake simulated_take(std::uint64_t seed, bool points, bool among_depth = false);

}  // namespace chorus::bench
