// The cost of fusing a long recording: a cell of six sensors as its recorder writes it, fused by
// the same program that users run.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/record/cell_writer.h"
#include "fusion-server/wire/registration_file.h"
#include "tests/bench/live/chorus_run.h"
#include "tests/bench/live/scratch_folder.h"
#include "tests/bench/report/report.h"
#include "tests/support/builders.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kSensors = 6;
constexpr double kRate = 30.0;         // [Hz]
constexpr double kLongMinutes = 60.0;  // the length that the claim states
constexpr double kQuickMinutes = 1.0;
constexpr double kNoise = 0.008;   // [m], on every coordinate
constexpr double kMaxRss = 200.0;  // [MB] the claim
constexpr std::size_t kDraws = 1 << 16;

struct OfflineCase {
  const char* name;
  int people;
  double share;             ///< Length, as a fraction of the requested one.
  double least_real_times;  ///< Claimed minimum of recorded time / run time.
};
constexpr std::array kCases{OfflineCase{"six-sensors", 1, 1.0, 150.0},
                            OfflineCase{"six-sensors-six-people", 6, 0.25, 30.0}};

double minutes(const Report& report) {
  const char* wanted = std::getenv("CHORUS_OFFLINE_MINUTES");
  if (wanted != nullptr) return std::clamp(std::atof(wanted), kQuickMinutes, 600.0);
  return report.quick() ? kQuickMinutes : kLongMinutes;
}

/// Noise that is the same in all runs with one seed and repeats too late for compression to notice.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : draws_(kDraws) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, kNoise);
    for (double& one : draws_) one = normal(random);
  }
  double next() { return draws_[at_++ * 40503 % kDraws]; }

 private:
  std::vector<double> draws_;
  std::size_t at_ = 0;
};

/// People walking in circles, as one sensor sees them.
SensorFrame seen(int sensor, int people, int number, Noise& noise) {
  const Timestamp t = testing::kStart + testing::kFrameInterval * number;
  const auto place = testing::ring_sensor(sensor, kSensors);
  const double seconds = number / kRate;
  std::vector<BodyFrame> bodies;
  for (int person = 0; person < people; ++person) {
    const double angle = 0.4 * seconds + person * 1.047;
    const double radius = people > 1 ? 1.2 : 0.6;
    const Eigen::Vector3d at(radius * std::cos(angle), 0, radius * std::sin(angle));
    BodyFrame body = testing::body_seen_from(place, testing::standing_person(at, -angle), t,
                                             static_cast<std::uint64_t>(person) + 1);
    for (Joint& joint : body.skeleton.joints)
      joint.position += Eigen::Vector3d(noise.next(), noise.next(), noise.next());
    bodies.push_back(std::move(body));
  }
  SensorFrame frame = testing::sensor_frame(fmt::format("s{}", sensor + 1), t, std::move(bodies));
  frame.sequence = static_cast<std::uint64_t>(number) + 1;
  return frame;
}

record::PlacesChanged places() {
  Registration registration;
  registration.version = 1;
  registration.verdict = Verdict::Good;
  registration.master = testing::sensor_id("s1");
  for (int i = 0; i < kSensors; ++i)
    registration.sensors[testing::sensor_id(fmt::format("s{}", i + 1))].world_from_sensor =
        testing::ring_sensor(i, kSensors);
  return wire::places_changed(testing::kStart, registration);
}

/// Writes the recording of a cell without fused frames.
Result<void> record_cell(const fs::path& file, int people, int frames, std::uint64_t seed) {
  auto writer = record::CellWriter::create(file, {});
  if (!writer) return pass(writer);
  if (auto ok = writer->write(places()); !ok) return ok;
  Noise noise(seed);
  for (int number = 0; number < frames; ++number) {
    for (int sensor = 0; sensor < kSensors; ++sensor) {
      const SensorFrame frame = seen(sensor, people, number, noise);
      const auto ok = writer->write(record::RawFrame{
          frame.sensor,
          std::make_shared<const resource::FrameResource>(resource::to_resource(frame)),
          frame.captured + std::chrono::milliseconds(2),
          testing::floor_seen_from(testing::ring_sensor(sensor, kSensors)),
          {}});
      if (!ok) return ok;
    }
  }
  return writer->close();
}

Result<void> measure(Report& report, const OfflineCase& each, double minutes_each) {
  const auto scratch = ScratchFolder::make();
  if (!scratch) return pass(scratch);
  const fs::path file = scratch->path() / "cell.mcap";
  const double length = std::max(kQuickMinutes, minutes_each * each.share) * 60.0;
  if (auto ok = record_cell(file, each.people, static_cast<int>(length * kRate), report.seed());
      !ok)
    return ok;
  for (const bool from_walk : {false, true}) {
    if (from_walk && each.people > 1) continue;  // a walk for registration is walked alone
    const std::string out = (scratch->path() / fmt::format("fused{}.mcap", from_walk)).string();
    std::vector<std::string> words{"fuse", file.string(), "--out", out};
    if (from_walk) words.emplace_back("--from-walk");
    const auto cost = run_chorus(words);
    if (!cost) return pass(cost);
    const std::string name = std::string(each.name) + (from_walk ? "-from-walk" : "");
    const double factor = length / cost->seconds;
    report.row(name, "recording_min", length / 60.0, "min");
    report.row(name, "file_mb", static_cast<double>(fs::file_size(file)) / 1e6, "MB");
    report.row(name, "real_time_factor", factor, "x");
    report.row(name, "rss_mb", cost->rss_mb, "MB");
    report.condition(fmt::format("{} is fused in at most {:.0f} MB", name, kMaxRss),
                     cost->rss_mb <= kMaxRss);
    report.condition(fmt::format("{} is fused at {:.0f} x real time", name, each.least_real_times),
                     factor >= each.least_real_times);
  }
  return {};
}

}  // namespace

Result<void> run_offline(Report& report) {
  report.profile("gauss");
  const double each = minutes(report);
  for (const OfflineCase& one : kCases) {
    if (auto ok = measure(report, one, each); !ok) return ok;
  }
  report.note(
      "chorus fuse CELL.mcap --out FUSED.mcap: reading, unpacking, fusing with the default method "
      "and writing the fused recording, scenes for viewers included; the largest resident set.  "
      "-from-walk finds the registration in a first pass.  CHORUS_OFFLINE_MINUTES sets the "
      "length.");
  return {};
}

}  // namespace chorus::bench
