// The recent instants of one inertial source, and what its sensors say at a common instant.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/strong_id.h"
#include "common/inertial/inertial_frame.h"

namespace chorus::inertial {

struct OrientationLimits {
  Duration span = std::chrono::seconds(5);
  /// Longest time between two samples of a sensor that orientations are interpolated across.
  Duration max_gap = std::chrono::milliseconds(200);
  /// A time that goes back by more than this means that the source's clock was set: the history
  /// begins anew.  By less, the instant is refused.
  Duration set_back = std::chrono::seconds(1);
};

class OrientationHistory {
 public:
  explicit OrientationHistory(OrientationLimits limits = {}) : limits_(limits) {}

  /// Adds an instant whose times are by our clock; false if it was refused.
  bool push(InertialFrame instant);

  /// What each sensor says at `instant`: its orientation between the samples around it (the shorter
  /// way round, at constant rate), angular rate and accelerations linearly; the covariance is the
  /// larger one.  Sensors without samples on both sides within max_gap are left out, unless one was
  /// taken at exactly that instant.
  [[nodiscard]] std::vector<InertialReading> at(Timestamp instant) const;

  [[nodiscard]] std::size_t size() const noexcept { return instants_.size(); }

 private:
  /// An instant, and from when to when its readings with an orientation are.
  struct Kept {
    InertialFrame frame;
    Timestamp first;
    Timestamp last;
  };
  using Readings = std::map<std::string_view, const InertialReading*>;

  void drop_oldest();
  [[nodiscard]] Readings last_until(Timestamp instant, Duration reach) const;
  [[nodiscard]] Readings first_from(Timestamp instant, Duration reach) const;

  OrientationLimits limits_;
  std::deque<Kept> instants_;
  /// Kept readings with an orientation, by sensor: who is found needs no longer search.
  std::map<std::string, std::size_t, std::less<>> spoken_;
};

/// What the suit that a person wears says at the common instant of the person's views.
struct Worn {
  PersonId person;
  SensorId source;
  std::vector<InertialReading> readings;
};

/// For each person of whom `wearers` knows which source they wear; people whose suit says nothing
/// at the instant are left out.
[[nodiscard]] std::vector<Worn> worn_at(Timestamp instant,
                                        const std::map<SensorId, OrientationHistory>& histories,
                                        const std::map<PersonId, SensorId>& wearers);

}  // namespace chorus::inertial
