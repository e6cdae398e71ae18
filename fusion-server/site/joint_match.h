// Which of our people are which of another cell's, all of them at once.
//
// Every assignment of ours to theirs is a hypothesis with a common error of its own: the first pair
// says what the error would be, and the others must agree with it.  Best-first, one of our people
// after another, with the hundred likeliest hypotheses kept (Reid 1979, within one scan).  The
// result is the probability of each pair, summed over the hypotheses.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "fusion-server/site/common_error.h"

namespace chorus::site {

/// Of theirs at most so many are matched at once.
inline constexpr std::size_t kMatchColumns = 64;

/// A pair that may be one person.
struct PossiblePair {
  std::size_t ours = 0;
  std::size_t theirs = 0;  ///< Below kMatchColumns.
  CommonTerm term;
  /// Log likelihood ratio of everything but the place: one person, against two who are anywhere in
  /// an area; includes the log of that area [m^2].
  double rest = 0.0;
};

struct JointMatch {
  std::size_t columns = 0;
  std::vector<double> pairs;  ///< Probability of each pair, row by row (ours, theirs).
  std::vector<double> none;   ///< That each of ours is none of theirs.

  [[nodiscard]] double at(std::size_t ours, std::size_t theirs) const {
    return pairs[ours * columns + theirs];
  }
};

/// The best of a row: one of theirs, or nobody.
struct Likeliest {
  std::optional<std::size_t> theirs;
  double probability = 0.0;
};
[[nodiscard]] Likeliest likeliest_of(const JointMatch& match, std::size_t ours,
                                     const std::function<bool(std::size_t)>& allowed);

struct MatchSize {
  std::size_t ours = 0;
  std::size_t theirs = 0;  ///< Those from kMatchColumns on are matched with nobody.
};

[[nodiscard]] JointMatch match_jointly(MatchSize size, std::span<const PossiblePair> pairs,
                                       const CommonError& error);

}  // namespace chorus::site
