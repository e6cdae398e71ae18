// True bodies into which gaps, jumps and changes of ids are written: the report counts them all.
#include <array>
#include <cmath>
#include <map>
#include <random>

#include <fmt/format.h>

#include "tests/bench/quality/report_cases.h"
#include "tests/bench/quality/simulated_day.h"

namespace chorus::bench {
namespace {

constexpr int kFrames = 1800;  // a minute at 30 Hz
constexpr Duration kStep{33'333'333};

/// What was written, joint by joint.
struct Written {
  std::array<std::size_t, kJointCount> hidden{};
  std::array<int, kJointCount> gaps{};
  std::array<int, kJointCount> jumps{};
  std::size_t switches = 0;
  std::size_t exchanges = 0;
  FusedFrames frames;
};

resource::BodyResource published(const Skeleton<WorldSpace>& body, std::uint64_t id, Timestamp at) {
  resource::BodyResource out;
  out.id = id;
  out.captured = at;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    static_cast<Joint&>(out.joints[j]) = body.joints[j];
    out.joints[j].contributors = 1;
  }
  return out;
}

/// Walkers of the simulator may walk through each other: each has a room of their own.
Skeleton<WorldSpace> apart(Skeleton<WorldSpace> body, std::size_t person) {
  for (Joint& joint : body.joints) joint.position.x() += 5.0 * static_cast<double>(person);
  return body;
}

FusedFrames true_frames(std::uint64_t seed, std::size_t people) {
  synthetic::WalkerScript script;
  script.seed = seed;
  synthetic::Scene scene;
  scene.people = synthetic::make_people(script, people);
  FusedFrames frames;
  const Timestamp begin = begin_of(seed);
  for (int i = 0; i < kFrames; ++i) {
    resource::FrameResource frame;
    frame.captured = begin + i * kStep;
    frame.source = "fusion";
    frame.space = resource::SpaceKind::World;
    frame.sensors = {"s1"};
    for (std::size_t person = 0; person < people; ++person)
      frame.bodies.push_back(published(apart(truth(scene, person, frame.captured), person),
                                       person + 1, frame.captured));
    frames.push_back(std::move(frame));
  }
  return frames;
}

/// Hides a joint of the first person for some frames; gaps do not touch.
void hide(Written& out, std::size_t joint, int from, int length) {
  for (int i = from; i < from + length; ++i)
    out.frames[static_cast<std::size_t>(i)].bodies[0].joints[joint].state = JointState::NotTracked;
  out.hidden[joint] += static_cast<std::size_t>(length);
  ++out.gaps[joint];
}

/// The joint is elsewhere from this frame on until the next leap takes it back: each is one step
/// that no body makes, and uniform motion from the step on is not one.
void leap(Written& out, std::size_t joint, int at) {
  for (int i = at; i < kFrames; ++i)
    out.frames[static_cast<std::size_t>(i)].bodies[0].joints[joint].position.y() +=
        out.jumps[joint] % 2 == 0 ? 0.3 : -0.3;
  ++out.jumps[joint];
}

Written written(std::uint64_t seed) {
  Written out;
  out.frames = true_frames(seed, 2);
  std::mt19937_64 random(seed);
  const auto drawn = [&](int most) {
    return static_cast<int>(random() % static_cast<unsigned>(most));
  };
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const int gaps = drawn(4);
    for (int k = 0; k < gaps; ++k) hide(out, j, 100 + 300 * k + drawn(100), 1 + drawn(60));
    const int jumps = drawn(3);
    for (int k = 0; k < jumps; ++k) leap(out, j, 1300 + 100 * k + drawn(50));
  }
  const int changes = drawn(4);
  for (int k = 0; k < changes; ++k) {
    ++out.switches;
    for (std::size_t i = static_cast<std::size_t>(200 + 350 * k + drawn(200)); i < kFrames; ++i)
      out.frames[i].bodies[1].id += 10;
  }
  return out;
}

}  // namespace

Result<void> report_counts(Report& report) {
  const std::size_t draws = report.quick() ? 2 : 20;
  std::size_t wrong = 0;
  std::map<std::string, double> counted;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    const Written truth = written(report.seed() + draw);
    quality::FusedJudge judge;
    for (const auto& frame : truth.frames) judge.add(frame);
    const quality::FusedQuality found = judge.finish();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto hidden = std::lround(found.joints[j].missing * 2 * kFrames);
      const bool equal = hidden == static_cast<long>(truth.hidden[j]) &&
                         found.joints[j].gaps == truth.gaps[j] &&
                         found.joints[j].jumps == truth.jumps[j];
      if (!equal) ++wrong;
      counted["hidden_instants"] += static_cast<double>(truth.hidden[j]);
      counted["gaps"] += truth.gaps[j];
      counted["jumps"] += truth.jumps[j];
    }
    if (found.switches.size() != truth.switches || !found.doubles.empty() || !found.turned.empty())
      ++wrong;
    counted["switches"] += static_cast<double>(truth.switches);
  }
  for (const auto& [what, count] : counted) report.row("counts", "planted_" + what, count, "");
  report.row("counts", "wrong_figures", static_cast<double>(wrong), "");
  report.condition(
      fmt::format("counts: coverage, gaps, jumps and switches of {} recordings equal the truth ({} "
                  "figures differ)",
                  draws, wrong),
      wrong == 0);
  return {};
}

}  // namespace chorus::bench
