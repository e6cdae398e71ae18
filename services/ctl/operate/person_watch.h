// Watches the fused frames of a running server while somebody shows a place in the room.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/base/result.h"

namespace chorus::ctl {

/// Passes each new frame on, once, as it comes, on one connection.  Ends when `take` returns true
/// or an error, or after `seconds`; returns whether `take` ended it.
[[nodiscard]] Result<bool> watch_frames(
    const std::string& server, double seconds,
    const std::function<Result<bool>(const nlohmann::json& frame)>& take);

/// What "--with" can name in addition to the joints: the middle between the two feet.
inline constexpr std::string_view kFeet = "feet";

/// Where this joint of the only person in the frame is above the floor: (x, z) [m].  NotFound:
/// nobody, or the joint is not seen; Conflict: several people.
[[nodiscard]] Result<Eigen::Vector2d> place_in(const nlohmann::json& frame, std::string_view joint);

/// When the frame was captured, in seconds since 1970; NaN if it does not say so.
[[nodiscard]] double seconds_of(const nlohmann::json& frame);

/// Waits until somebody stands still, away from where they stood before.
class Standstill {
 public:
  /// `length`: for how long [s].  Places nearer than `apart` [m] to one of `before` do not count.
  Standstill(double length, std::vector<Eigen::Vector2d> before, double apart)
      : length_(length), before_(std::move(before)), apart_(apart) {}

  /// The mean place once they have stood still; `at`: of the frame [s].
  [[nodiscard]] std::optional<Eigen::Vector2d> take(const Eigen::Vector2d& place, double at);
  /// Begins anew: nobody was seen, or several people were.
  void interrupt() { seen_.clear(); }

 private:
  struct Seen {
    Eigen::Vector2d place;
    double at;
  };
  double length_;
  std::vector<Eigen::Vector2d> before_;
  double apart_;
  std::deque<Seen> seen_;
};

}  // namespace chorus::ctl
