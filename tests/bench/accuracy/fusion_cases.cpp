#include "tests/bench/accuracy/fusion_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/base/units.h"
#include "common/synthetic/draw.h"
#include "tests/judge/cold_start.h"

namespace chorus::bench {
namespace {

using synthetic::PathKind;

constexpr Duration kLength = std::chrono::seconds(30);
constexpr Duration kRenderedLength = std::chrono::seconds(10);  // profile C renders images
constexpr Duration kColdLength = std::chrono::seconds(12);

/// The scenes with a ring of six sensors and one person: walking, standing, turning, at work, and
/// cold starts.
std::vector<FusionCase> scenes_of(const std::string& profile) {
  const std::string name = "workshop6-" + profile;
  FusionCase cold{name + "-cold", contest_of(profile, 6, PathKind::Random), true};
  cold.contest.setting.length = std::min(cold.contest.setting.length, kColdLength);
  cold.cold = true;
  return {{name, contest_of(profile, 6, PathKind::Random), true},
          {name + "-stand", contest_of(profile, 6, PathKind::Stand), true},
          {name + "-turn", contest_of(profile, 6, PathKind::Turn), true},
          {name + "-assembly", contest_of(profile, 6, PathKind::Assembly), true},
          std::move(cold)};
}

/// Walks in which the places of the sensors are those that the product finds from the same walk.
std::vector<FusionCase> registered_cases() {
  std::vector<FusionCase> cases;
  for (const std::size_t sensors : {6U, 3U, 2U}) {
    for (const char* profile : {"A", "B", "D"}) {
      const std::string ring = sensors == 6 ? "workshop6" : fmt::format("sensors-{}", sensors);
      cases.push_back({fmt::format("{}-{}-own-registration", ring, profile),
                       contest_of(profile, sensors, PathKind::Random), true});
      cases.back().contest.own_registration = true;
    }
  }
  return cases;
}

/// The yaws at which every sensor swaps left and right, and swaps them back [rad].
struct Flips {
  double out;
  double back;
};

void exchange_at(synthetic::kinect::YawBehaviour& yaw, const Flips& flips) {
  yaw.flip_to_rear = flips.out;
  yaw.flip_to_front = flips.back;
  yaw.flip_own = yaw.flip_back_own = 0.0;
}

FusionCase flip_case(std::string name, const Flips& flips) {
  FusionCase each{std::move(name), contest_of("A", 6, PathKind::Random)};
  each.contest.setting.adjust = [flips](synthetic::kinect::Profile& profile, std::size_t) {
    exchange_at(profile.yaw, flips);
  };
  return each;
}

}  // namespace

Contest contest_of(const std::string& profile, std::size_t sensors, PathKind walk) {
  Contest contest;
  contest.setting.profile = profile;
  synthetic::Ring ring;
  ring.count = sensors;
  contest.setting.places = ring_places(ring);
  contest.setting.walk = walk;
  contest.setting.length = profile == "C" ? kRenderedLength : kLength;
  return contest;
}

std::vector<FusionCase> main_cases() {
  std::vector<FusionCase> cases;
  for (const char* profile : {"A", "B", "C", "D"}) {
    for (FusionCase& each : scenes_of(profile)) cases.push_back(std::move(each));
  }
  for (const char* profile : {"A", "B", "D"}) {
    for (const std::size_t sensors : {1U, 2U, 3U}) {
      cases.push_back({fmt::format("sensors-{}-{}", sensors, profile),
                       contest_of(profile, sensors, PathKind::Random), true});
    }
  }
  cases.push_back({"sensors-10-A", contest_of("A", 10, PathKind::Random)});
  for (const char* profile : {"A", "B", "D"}) {
    cases.push_back({fmt::format("workshop6-{}-by-shoulders", profile),
                     contest_of(profile, 6, PathKind::Random)});
    cases.back().contest.pipeline.sides.by = facing::SidesBy::Shoulders;
  }
  for (FusionCase& each : registered_cases()) cases.push_back(std::move(each));
  for (FusionCase& each : cases) {
    each.quick =
        each.name == kMainCase || each.name == "workshop6-A-cold" || each.name == "workshop6-D";
  }
  return cases;
}

std::vector<FusionCase> flip_cases() {
  constexpr double kOut = deg(130);
  constexpr double kBack = deg(60);
  constexpr double kNever = deg(360);
  std::vector<FusionCase> cases;
  for (const int out : {95, 105, 115, 125, 140}) {
    cases.push_back(flip_case(fmt::format("flip-out-{}", out), {deg(out), kBack}));
  }
  for (const int back : {100, 75, 55, 40}) {
    cases.push_back(flip_case(fmt::format("flip-back-{}", back), {kOut, deg(back)}));
  }
  cases.push_back(flip_case("flip-none", {kNever, kNever}));
  FusionCase mixed{"flip-mixed", contest_of("A", 6, PathKind::Random)};
  mixed.contest.setting.adjust = [](synthetic::kinect::Profile& profile, std::size_t place) {
    if (place % 2 == 0) exchange_at(profile.yaw, {kNever, kNever});
  };
  cases.push_back(std::move(mixed));
  return cases;
}

void begin_cold(Setting& setting, std::size_t draw) {
  constexpr std::uint64_t kPurpose = 771;
  constexpr double kBuildSpread = 0.08;  // the same as for people who walk from the start
  ColdScript script{static_cast<ColdStart>(draw % kColdStarts.size()), setting.seed,
                    begin_of(setting.seed)};
  script.body_scale += synthetic::Draw{setting.seed, kPurpose}.uniform(-kBuildSpread, kBuildSpread);
  setting.people = {cold_starter(script)};
}

}  // namespace chorus::bench
