// One person over time: from bodies, instant by instant, to what the methods score.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "common/body/skeleton.h"
#include "common/ergonomics/doubt.h"
#include "common/posture/movement.h"
#include "common/posture/neutral.h"
#include "common/posture/spread.h"

namespace chorus::ergonomics {

/// A fused body of one person.
struct BodyAt {
  Timestamp at;
  Skeleton<WorldSpace> body;
  double sides_confidence = 1.0;
  bool carried = false;  ///< No sensor sees the person; the body is only expected.
};

/// Why an instant has no score.
enum class Unscored : std::uint8_t { None, Carried, NotSeen, Singular };
inline constexpr std::size_t kReasons = 4;
[[nodiscard]] std::string_view name_of(Unscored reason);

/// What is known of a person at an instant.
struct Observation {
  Timestamp at;
  Seen seen;  ///< The held posture, relative to the person's own stance if it is known.
  std::array<Measures, posture::kDraws> draws;  ///< About it.
  Measures shown;                               ///< `seen`, steadied: for what people watch.
  double sides_confidence = 1.0;
  std::size_t doubtless = 0;  ///< Joints without a stated doubt, which count as exact.
  Unscored reason = Unscored::None;
};

[[nodiscard]] DoubtfulScore score_of(const Method& method, const Observation& observation,
                                     const Asked& asked);

struct ObserverConfig {
  bool held = true;  ///< False: every instant by itself, without the median over a second.
};

class Observer {
 public:
  explicit Observer(ObserverConfig config = {}) : config_(config) {}

  void stance(posture::Neutral neutral) { neutral_ = std::move(neutral); }
  void forget_stance() { neutral_.reset(); }
  [[nodiscard]] const std::optional<posture::Neutral>& stance() const { return neutral_; }

  /// Bodies in the order of time.
  [[nodiscard]] Observation observe(const BodyAt& body);

 private:
  ObserverConfig config_;
  std::optional<posture::Neutral> neutral_;
  posture::Walk walk_;
  posture::Held held_;
  posture::Steady steady_;
};

/// The stance that this recording of one person shows: what a task file states, or found by itself.
[[nodiscard]] std::optional<posture::Neutral> stance_in(const std::vector<BodyAt>& bodies);

/// A score for watching: it changes only after the new one has lasted 0.3 s.
class ShownScore {
 public:
  [[nodiscard]] ScoreRange follow(Timestamp at, const ScoreRange& score);

 private:
  ScoreRange shown_;
  ScoreRange next_;
  Timestamp since_;
};

}  // namespace chorus::ergonomics
