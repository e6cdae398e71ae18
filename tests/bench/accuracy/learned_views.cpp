#include "tests/bench/accuracy/learned_views.h"

#include <array>

#include "common/base/units.h"

namespace chorus::bench {

Contest learning_contest(const std::string& profile, std::size_t draw) {
  using synthetic::PathKind;
  constexpr std::array kMotions{PathKind::Circle, PathKind::Assembly, PathKind::Line,
                                PathKind::Turn};
  constexpr std::uint64_t kFirstSeed = 1001;
  // Rings of other sizes and heights than the workshop's, which has six at 3.0 and 1.6 m.
  constexpr std::array kRings{synthetic::Ring{5, 3.4, 1.8, deg(16)},
                              synthetic::Ring{4, 2.6, 1.3, deg(9)}};
  Contest contest;
  contest.setting.profile = profile;
  contest.setting.seed = kFirstSeed + draw;
  contest.setting.walk = kMotions[draw % kMotions.size()];
  contest.setting.places = ring_places(kRings[(draw / kMotions.size()) % kRings.size()]);
  contest.setting.length = std::chrono::seconds(20);
  return contest;
}

Samples simulated_samples(const Contest& contest, std::size_t step) {
  const Course course = course_of(contest);
  Samples samples;
  for (std::size_t i = 0; i < course.instants.size(); i += step) {
    if (course.given[i]) learn::add_samples(*course.given[i], course.exact[i], samples);
  }
  return samples;
}

}  // namespace chorus::bench
