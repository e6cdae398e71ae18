// Named postures: rules over measures, read from a text file (tables/postures.txt shows the form),
// and the stretches of time in which one holds.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/ergonomics/live.h"

namespace chorus::ergonomics {

enum class Sides : std::uint8_t { Centre, Either, Both };

struct Condition {
  std::size_t measure = 0;  ///< Of the left side for limbs.
  Sides sides = Sides::Centre;
  bool absolute = false;
  bool above = true;              ///< The value is larger than the limit, else smaller.
  double limit = 0.0;             ///< [rad] or [m]
  std::optional<Legs> legs = {};  ///< If set, the condition is about the legs alone.
};

struct PostureRule {
  std::string name;
  Duration lasts{};
  std::vector<Condition> conditions;
};

/// Malformed names the line, and the nearest measure for an unknown one.
[[nodiscard]] Result<std::vector<PostureRule>> read_rules(std::string_view text,
                                                          const std::string& file);
/// The rules that come with the program.
[[nodiscard]] const std::vector<PostureRule>& shipped_rules();

/// False where a measure is unknown.
[[nodiscard]] bool holds(const PostureRule& rule, const Seen& seen);

struct PostureEvent {
  std::string name;
  Timestamp from;
  Timestamp until;
  double probability = 0.0;  ///< Mean over the instants, from the drawn bodies.
  bool open = false;         ///< It had not ended.
};

/// Watches one person.
class PostureWatch {
 public:
  explicit PostureWatch(std::vector<PostureRule> rules);
  /// The events that ended with this instant.
  [[nodiscard]] std::vector<PostureEvent> add(const Observation& observation);
  /// The events that go on, and have lasted long enough.
  [[nodiscard]] std::vector<PostureEvent> current() const;
  [[nodiscard]] std::vector<PostureEvent> finish();

 private:
  struct Running {
    bool on = false;
    Timestamp from;
    Timestamp last;
    double odds = 0.0;
    double count = 0.0;
  };
  [[nodiscard]] std::optional<PostureEvent> event_of(std::size_t rule, bool open) const;

  std::vector<PostureRule> rules_;
  std::vector<Running> running_;
};

}  // namespace chorus::ergonomics
