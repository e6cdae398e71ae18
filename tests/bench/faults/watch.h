// What a client of the fusion server sees while something goes wrong.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/body/located.h"
#include "common/time/timestamp.h"

namespace chorus::bench {

struct FusedInstant {
  std::int64_t sequence = 0;
  Timestamp instant;
  Timestamp received;  ///< By the clock of this host.
  std::vector<std::uint64_t> bodies;
  std::vector<Eigen::Vector3d> places;  ///< Where each body's SpineBase is, world [m].
  std::vector<Located> joints;          ///< Each body's joints, world [m].
  std::set<std::string> contributors;   ///< Sensors that contributed to any joint.
};

/// Long-polls /frame in JSON on a thread of its own.
class Watch {
 public:
  explicit Watch(std::uint16_t port);
  ~Watch();

  /// All frames until now.  Frames that the watcher was too slow for are fetched afterwards.
  [[nodiscard]] std::vector<FusedInstant> seen() const;
  /// The newest frame; its sequence is 0 if there is none yet.
  [[nodiscard]] FusedInstant newest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Summary of some of the frames seen.
struct Account {
  double hz = 0.0;  ///< Frames received, per second.
  std::size_t frames = 0;
  std::size_t lost = 0;                 ///< Instants without a frame, or whose frame has no body.
  double longest_gap = 0.0;             ///< Between two receipts, or after the last [s]
  double age_p50 = 0.0;                 ///< Median time from instant to receipt [s]
  double age_p90 = 0.0;                 ///< 90th percentile of this time [s]
  double several_percent = 0.0;         ///< Frames with more than one body.
  std::map<std::string, double> share;  ///< Frames that each sensor contributed to [percent].

  [[nodiscard]] double share_of(const std::string& sensor) const;
};

/// Frames received from `from` (inclusive) to `to`; how many are due follows from 30 Hz.
[[nodiscard]] Account account_of(std::span<const FusedInstant> seen, Timestamp from, Timestamp to);

/// Time from `since` to the first receipt after which, for a second, every frame had a body and all
/// of these sensors contributed [s]; infinite: never.
[[nodiscard]] double recovery(std::span<const FusedInstant> seen, Timestamp since,
                              const std::vector<std::string>& sensors);

}  // namespace chorus::bench
