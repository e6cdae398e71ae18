// Scores of everybody that a tracker sees, frame by frame.  No socket, no thread, no clock.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/ergonomics/live.h"
#include "common/ergonomics/named_postures.h"
#include "common/resource/frame_resource.h"

namespace chorus::ergonomics_service {

/// Whether the person's own stance is known.
enum class Stance : std::uint8_t { Missing, Asked, Known };

struct PersonScores {
  std::uint64_t person = 0;
  Timestamp captured;
  ergonomics::Unscored reason = ergonomics::Unscored::None;
  Stance stance = Stance::Missing;
  std::string stance_trouble;  ///< Why the last attempt found none; empty: nothing was tried.
  std::vector<ergonomics::DoubtfulScore> scores;   ///< In the order of the methods.
  std::vector<ergonomics::ScoreRange> shown;       ///< The same without flicker.
  std::vector<ergonomics::PostureEvent> postures;  ///< That go on.
};

struct ScoreFrame {
  std::uint64_t sequence = 0;
  Timestamp captured;
  std::vector<PersonScores> persons;
};

/// How far back ?at= reaches.
inline constexpr Duration kKept = std::chrono::seconds(30);

class Scoring {
 public:
  Scoring(std::vector<const ergonomics::Method*> methods,
          std::vector<ergonomics::PostureRule> rules);

  [[nodiscard]] const std::vector<const ergonomics::Method*>& methods() const { return methods_; }
  [[nodiscard]] const ergonomics::Asked& asked() const { return asked_; }
  void ask(ergonomics::Asked asked) { asked_ = std::move(asked); }

  /// Scores a frame.  Frames that are not newer than the last are left out (the last is returned).
  /// A person whom no frame shows for ten seconds is forgotten, with their stance.
  const ScoreFrame& take(const resource::FrameResource& frame);

  /// Begins to watch this person for two seconds, standing upright; NotFound if nobody has this id.
  [[nodiscard]] Result<void> ask_stance(std::uint64_t person);

  [[nodiscard]] const ScoreFrame& latest() const;
  /// The scores of the instant nearest to `at`; none before kKept or after the latest.
  [[nodiscard]] const ScoreFrame* at(Timestamp at) const;

 private:
  struct Watched {
    ergonomics::Observer observer;
    ergonomics::PostureWatch postures;
    std::vector<ergonomics::ShownScore> shown;
    std::vector<posture::Instant> standing;  ///< While the stance is asked.
    Stance stance = Stance::Missing;
    std::string trouble;
    Timestamp asked;
    Timestamp last;
  };

  Watched& watched(std::uint64_t person, Timestamp at);
  void watch_stance(Watched& person, const ergonomics::BodyAt& body);
  PersonScores scored(std::uint64_t id, const ergonomics::BodyAt& body);

  std::vector<const ergonomics::Method*> methods_;
  std::vector<ergonomics::PostureRule> rules_;
  ergonomics::Asked asked_;
  std::map<std::uint64_t, Watched> people_;
  std::deque<ScoreFrame> kept_{ScoreFrame{}};
};

}  // namespace chorus::ergonomics_service
