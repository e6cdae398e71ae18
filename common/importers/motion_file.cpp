#include "common/importers/motion_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace chorus::importers {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

FloorPlane floor_of_world() { return {Eigen::Vector3d::UnitY(), 0.0}; }

/// The body as the ideal sensor sees it: world and sensor space coincide.
Skeleton<SensorSpace> as_seen(const Skeleton<WorldSpace>& body) {
  return to_sensor(Eigen::Isometry3d::Identity(), body);
}

std::size_t joints_in(const std::vector<motion::Motion>& persons) {
  std::array<bool, kJointCount> there{};
  for (const auto& person : persons) {
    for (const auto& body : person.frames) {
      for (std::size_t j = 0; j < kJointCount; ++j) there[j] = there[j] || body.joints[j].seen();
    }
  }
  return static_cast<std::size_t>(std::count(there.begin(), there.end(), true));
}

bool anybody(const Skeleton<WorldSpace>& body) {
  return std::any_of(body.joints.begin(), body.joints.end(),
                     [](const Joint& joint) { return joint.seen(); });
}

/// Seconds from the first frame to frame f.
double time_of(const motion::Motion& motion, std::size_t f) {
  if (motion.times.size() == motion.frames.size()) return motion.times[f] - motion.times.front();
  return static_cast<double>(f) / motion.rate_hz;
}

/// How many frames of the rate are missing between those that are there.
std::size_t missing_in(const motion::Motion& motion) {
  std::size_t missing = 0;
  for (std::size_t f = 1; f < motion.frames.size(); ++f) {
    const double steps = (time_of(motion, f) - time_of(motion, f - 1)) * motion.rate_hz;
    if (steps > 1.5) missing += static_cast<std::size_t>(std::llround(steps)) - 1;
  }
  return missing;
}

void add_frames(MotionRecording& out, const Captured& captured, const ImportOptions& options) {
  const motion::Motion& first = captured.persons.front();
  const FloorPlane floor = options.floor.value_or(floor_of_world());
  for (std::size_t f = 0; f < first.frames.size(); ++f) {
    const double ns = kNanosecondsPerSecond * time_of(first, f);
    const Timestamp instant = options.start + Duration(std::llround(ns));
    SensorFrame frame{out.recording.sensor, f + 1, instant, instant, {}, floor};
    for (std::size_t p = 0; p < captured.persons.size(); ++p) {
      const Skeleton<WorldSpace>& body = captured.persons[p].frames[f];
      if (!anybody(body)) continue;
      frame.bodies.push_back({BodyId{captured.ids[p]}, instant, as_seen(body)});
      out.truth.push_back({f, body, captured.ids[p]});
    }
    out.recording.frames.push_back(std::move(frame));
  }
}

Result<void> check_length(const motion::Motion& motion, const std::string& origin) {
  const double last = motion.frames.empty() ? 0.0 : time_of(motion, motion.frames.size() - 1);
  if (last >= 0.0 && last <= kMaxSeconds) return {};
  return fail(ErrorCode::TooLarge, origin,
              fmt::format("holds {} frames at {:.6g} Hz, which is more than a week.",
                          motion.frames.size(), motion.rate_hz));
}

void add_notes(MotionRecording& out, const Captured& found) {
  auto& notes = out.recording.notes;
  const motion::Motion& first = found.persons.front();
  notes["joints"] =
      fmt::format("{} of our {} joints are in the file", joints_in(found.persons), kJointCount);
  notes["time"] = fmt::format("{:.6g} Hz in the file, no UTC", first.rate_hz);
  if (const std::size_t missing = missing_in(first); missing > 0)
    notes["gaps"] =
        fmt::format("{} frames are missing between the others, by their times", missing);
  for (std::size_t i = 0; i < found.damage.size(); ++i)
    notes["damage." + std::to_string(i + 1)] = found.damage[i];
}

}  // namespace

Result<MotionRecording> read_motion_file(const std::filesystem::path& file, MotionFormat format,
                                         const ImportOptions& options) {
  const auto sensor = sensor_for(file, options);
  if (!sensor) return pass(sensor);
  auto found = read_captured(file, format, options);
  if (!found) return pass(found);
  if (found->persons.size() > kMaxBodies)
    return fail(ErrorCode::TooLarge, file.string(), "holds more than 64 persons.");
  if (auto ok = check_length(found->persons.front(), file.string()); !ok) return pass(ok);
  MotionRecording out;
  out.space = found->space;
  out.recording.sensor = *sensor;
  out.recording.device = found->device;
  out.recording.floor = options.floor.value_or(floor_of_world());
  out.recording.notes = found->notes;
  out.recording.notes["origin"] = file.filename().string();
  add_notes(out, *found);
  add_frames(out, *found, options);
  return out;
}

}  // namespace chorus::importers
