// Follows one person in a suit through the pictures of cameras, instant by instant.  Pure; online:
// uses no later picture.
//
// Landmarks, outline, and both go through one filter with the suit's steps; there, what a camera's
// landmarks and its outline say are two cameras, each with errors of its own.  The paper's method
// adds shifts to the last place, and the suit alone adds its steps.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/positioning/landmark_fit.h"
#include "common/positioning/method.h"
#include "common/positioning/picture_sight.h"
#include "common/positioning/position_filter.h"
#include "common/suit/footing.h"

namespace chorus::positioning {

/// What a camera's picture says where the person is: one entry for each of the people whom it
/// could be.
struct Look {
  std::size_t camera = 0;
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  std::vector<Skeleton<SensorSpace>> people;  ///< As rays.
  /// What the picture itself says, for the methods that ask it; null: nothing.
  std::shared_ptr<const PictureSight> sight = {};
};

struct Instant {
  suit::SuitPose pose;
  std::vector<Look> looks;  ///< Of the pictures taken at this instant; often none.
};

struct Tracked {
  Position position;
  suit::Stance stance = suit::Stance::Unknown;
  std::size_t cameras = 0;  ///< Number of cameras that saw the person at this instant.
  Duration hidden{0};       ///< Since a camera last saw the person.
  double misfit = 0.0;      ///< Of the best fit [standard deviations]; 0 without one.
  bool ambiguous = false;   ///< A picture shows another place that fits as well.
};

struct TrackerSettings {
  std::size_t cameras = 1;
  double stature = 1.75;  ///< [m]
  PositionErrors errors{};
  /// Heading of the suit, if it is known already [rad]; otherwise all headings are tried.
  std::optional<double> heading = {};
  Method method = Method::Landmarks;
  /// Where the person is at first, if that is known (the board, Madaras et al. 3.3) [m]; its height
  /// is the suit's.
  std::optional<Eigen::Vector3d> start = {};
};

class Tracker {
 public:
  explicit Tracker(const TrackerSettings& settings);

  /// None before a camera has seen the person.  Poses must come in time order; their times are
  /// those of the pictures.
  std::optional<Tracked> next(const Instant& instant);

  [[nodiscard]] const PositionFilter& filter() const { return filter_; }
  /// Pictures in which somebody was, but nobody whose pose is the suit's.
  [[nodiscard]] std::uint64_t strangers() const { return strangers_; }

 private:
  struct Found {
    Seen seen;
    double misfit = 0.0;
    double heading = 0.0;
  };
  [[nodiscard]] bool knows_heading() const { return filter_.begun() || settings_.heading; }
  [[nodiscard]] std::optional<Found> found_as(const SeenRays& seen, const suit::SuitPose& pose,
                                              std::size_t camera) const;
  [[nodiscard]] std::optional<Found> found_in(const Look& look, const suit::SuitPose& pose) const;
  [[nodiscard]] bool accept(const Found& found, Tracked& out);
  void begin(const Found& found);
  /// By the filter.
  std::optional<Tracked> filtered(const Instant& instant, const suit::Step& step, double dt);
  /// By the suit's steps, or by the paper's search, from a place that is stated or found.
  std::optional<Tracked> added_up(const Instant& instant, const suit::Step& step);
  void outline(const Look& look, const Instant& instant, double height, Tracked& out);
  [[nodiscard]] std::optional<SightedPlace> first_sight(const Instant& instant, double height);
  void search(const Instant& instant, Tracked& out);
  /// Whether the whole floor may be searched now: that takes as long as many pictures.
  [[nodiscard]] bool may_search(Duration now);
  [[nodiscard]] std::size_t outline_camera(std::size_t camera) const;

  TrackerSettings settings_;
  suit::Footing footing_;
  PositionFilter filter_;
  std::optional<Duration> last_{};
  std::optional<Duration> last_seen_{};
  int refused_ = 0;
  int misfits_ = 0;  ///< Pictures in a row in which nobody fits.
  std::uint64_t strangers_ = 0;
  std::optional<Duration> searched_{};        ///< When the whole floor was last searched.
  std::optional<SightedPlace> last_place_{};  ///< Of the methods without a filter.
  double walked_ = 0.0;                       ///< Since last_place_ was seen [m].
};

}  // namespace chorus::positioning
