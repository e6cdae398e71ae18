// A method of posture assessment as a value: which inputs it needs, how each is obtained, and the
// score, level and text that follow.
//
// An input is a small whole number, its code on the printed form.  A code of 0 is unknown; scores
// are then computed with its lowest and its highest code and become a range.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/ergonomics/asked.h"
#include "common/ergonomics/seen.h"

namespace chorus::ergonomics {

/// A text in the languages of the sheets.
struct Text {
  std::string_view en;
  std::string_view de;
};

enum class Origin : std::uint8_t { Measured, Asked };

struct Input {
  std::string_view key;  ///< "upperArm"
  Text name;
  Origin origin = Origin::Measured;
  int lowest = 1;
  int highest = 1;
  /// What the lowest code means, for "REBA 4 to 5 if ..."; of asked inputs.
  Text lowest_if = {};
};

struct Level {
  int from = 1;  ///< The lowest score of the level.
  std::string_view key;
  Text text;
};

inline constexpr std::size_t kMaxInputs = 12;
inline constexpr int kMaxScore = 15;
using Codes = std::array<std::int8_t, kMaxInputs>;  ///< In the order of Method::inputs; 0: unknown.

/// A value on the way to a score, as the form prints it ("Score A" 5).
struct Step {
  Text name;
  int value = 0;
};

struct Method {
  std::string_view name;  ///< "reba"
  Text title;
  std::string_view source;
  std::span<const Input> inputs;
  std::span<const Level> levels;
  int highest = 1;      ///< The highest score; the lowest is 1.
  bool sided = false;   ///< Scored for each side; the person's score is the higher one.
  bool ordered = true;  ///< False: the numbers name classes; a higher one is not worse.
  void (*measure)(const Seen& seen, Side side, Codes& codes);
  void (*ask)(const Asked& asked, Codes& codes);
  int (*score)(const Codes& codes);  ///< All codes must be known.
  std::vector<Step> (*steps)(const Codes& codes);
};

/// REBA, RULA, OWAS, ISO 11226, EN 1005-4 and the EAWS-like classes.
[[nodiscard]] std::span<const Method* const> methods();
/// NotFound names the nearest method and all others.
[[nodiscard]] Result<const Method*> find_method(std::string_view name);
/// "reba,owas"; refuses repeated names.
[[nodiscard]] Result<std::vector<const Method*>> find_methods(std::string_view list);

/// The level that a score belongs to, as an index of Method::levels.
[[nodiscard]] std::size_t level_of(const Method& method, int score);

/// Codes of one side: measured ones, then the asked ones.
[[nodiscard]] Codes codes_of(const Method& method, const Seen& seen, Side side, const Asked& asked);

/// A score, or the range that unknown inputs leave.
struct ScoreRange {
  int low = 0;  ///< 0: no measured input is known.
  int high = 0;

  [[nodiscard]] bool known() const { return low > 0; }
  bool operator==(const ScoreRange&) const = default;
};

[[nodiscard]] ScoreRange score_of(const Method& method, const Codes& codes);

/// The higher of both sides, end by end.
[[nodiscard]] ScoreRange worse(const ScoreRange& a, const ScoreRange& b);

/// "REBA 4 to 6; 4 to 5 if the load is under 5 kg": a range with what would narrow it.
[[nodiscard]] std::string range_text(const Method& method, const Codes& codes, bool german);

}  // namespace chorus::ergonomics
