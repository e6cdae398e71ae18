// What a track has seen of its person's build, cut into tracklets, and whether all of them are one
// person's.
//
// Sensors may go over from one person to another: where nobody saw the person for a while, where
// all bodies that show the person are new, and, rarely, at any time.  There the track is cut; a
// tracklet in view for a second is cut, too.  For each cut, the builds before and after it are
// compared, at every instant: a likelihood ratio test for a change at one of several known times.
// So it does not matter when the change is noticed: the track can be split where it happened.
//
// A sensor may go over to somebody else without giving the body another id.  Several sensors do so
// at one time if two people pass each other, but hardly to somebody whom no sensor has seen before:
// for that, the prior log odds are kUnbroken for each body that shows the person before and after a
// cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/time/timestamp.h"
#include "fusion-server/associate/build.h"

namespace chorus::associate {

/// A sensor's body that shows the person.
struct Carrier {
  std::uint64_t body = 0;  ///< Of sensor and body id: key_of().
  double time = 0.0;       ///< How long in view [s].
};

[[nodiscard]] std::uint64_t key_of(const SensorId& sensor, BodyId body);

/// Sight of one track in which nothing suggests a change of the person.
struct Tracklet {
  Timestamp begin;  ///< Its first instant in view.
  Timestamp end;    ///< Its last one.
  /// Prior log odds that the person is the one of the tracklet before.
  double continuity = 0.0;
  bool by_time = true;   ///< True if only the time has made the cut before it.
  double carried = 0.0;  ///< Doubt::carried of that cut, once it is known.
  Build build = {};
  double time = 0.0;                   ///< In view [s].
  std::vector<Carrier> carriers = {};  ///< Kept of the newest three tracklets.
};

/// A cut and the log odds that the person after it is the one before it, by the builds and
/// Tracklet::continuity.
struct Doubt {
  std::size_t cut = 0;  ///< Index of the first tracklet after it.
  double odds = 0.0;
  /// What is added to the log odds against somebody new: the bodies that go on.
  double carried = 0.0;

  [[nodiscard]] double against_new() const { return odds + carried; }
};

class Tracklets {
 public:
  /// Continuity at a cut that only the time has made.
  static constexpr double kUnbroken = 6.0;

  /// Makes a cut before the next add().  A tracklet that was hardly in view is not cut again, but
  /// gets the lower of the two continuities.
  void cut(double continuity);
  /// Adds the lengths of one instant that lasts for `elapsed` [s], at which `bodies` (key_of())
  /// show the person.
  void add(const Spans& spans, Timestamp instant, double elapsed,
           std::span<const std::uint64_t> bodies = {});
  /// Puts what is known of a person, last seen at `seen`, before the first tracklet.
  void precede(const Build& known, Timestamp seen, double continuity);

  /// The cut at which the person most likely changed; none if one side of each cut has no length.
  [[nodiscard]] std::optional<Doubt> doubt(const Repeatability& repeatability) const;

  [[nodiscard]] Build before(std::size_t cut) const;
  [[nodiscard]] Build after(std::size_t cut) const;
  [[nodiscard]] Build whole() const { return after(0); }
  /// Ordered by time; at most a dozen, because the oldest are joined.
  [[nodiscard]] std::span<const Tracklet> all() const { return tracklets_; }
  /// Drops the tracklets before the cut.
  void keep_after(std::size_t cut);

 private:
  [[nodiscard]] double carried(std::size_t cut) const;
  void begin(Timestamp instant);

  std::vector<Tracklet> tracklets_;
  /// Continuity of a tracklet that the next add() begins.
  std::optional<double> next_;
};

}  // namespace chorus::associate
