#include "common/importers/motion_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "common/base/parse.h"
#include "common/importers/import_options.h"
#include "common/importers/text_rows.h"
#include "common/motion/bvh.h"
#include "common/motion/c3d.h"
#include "common/motion/motion.h"
#include "common/motion/mvnx.h"

namespace chorus::importers {
namespace {

constexpr std::size_t kShownLabels = 40;
constexpr double kNanosecondsPerSecond = 1e9;
// Thighs of toddlers and of giants in animations [m].
constexpr double kShortestThigh = 0.1;
constexpr double kLongestThigh = 2.0;

/// What every reader returns: one motion per person, all of the same length.
struct Captured {
  std::string device;
  std::vector<motion::Motion> persons;
  std::vector<std::uint64_t> ids;  ///< Ids of the persons.
  std::map<std::string, std::string> notes = {};
};

std::string list_of(const std::vector<std::string>& labels) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kShownLabels, labels.size()); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : " ", labels[i].substr(0, 32));
  return labels.size() > kShownLabels ? text + " ..." : text;
}

/// "P10" -> 10: files that Chorus exports name persons like this.
std::optional<std::uint64_t> person_named(std::string_view name) {
  if (!name.starts_with('P')) return std::nullopt;
  return parse_number<std::uint64_t>(name.substr(1));
}

/// The ids in the subjects' names, if every name has a different one; otherwise 1, 2, ... in the
/// order of the file.
std::vector<std::uint64_t> ids_of(const std::vector<motion::C3dSubject>& subjects) {
  std::vector<std::uint64_t> ids;
  for (const auto& subject : subjects) {
    const auto id = person_named(subject.name);
    if (id && std::find(ids.begin(), ids.end(), *id) == ids.end()) ids.push_back(*id);
  }
  if (ids.size() == subjects.size()) return ids;
  ids.resize(subjects.size());
  std::iota(ids.begin(), ids.end(), std::uint64_t{1});
  return ids;
}

Result<Captured> captured_c3d(const std::string& bytes, const std::string& origin) {
  const auto c3d = motion::parse_c3d(bytes, origin);
  if (!c3d) return pass(c3d);
  auto found = motion::motion_from_c3d(*c3d);
  if (!found) return fail(found.error().code, origin, to_string(found.error()));
  Captured out{"C3D (" + c3d->processor + ")", {}, ids_of(found->subjects)};
  for (auto& subject : found->subjects) out.persons.push_back(std::move(subject.motion));
  if (!found->unused_labels.empty())
    out.notes["labels"] =
        fmt::format("{} of {} points are no joint: {}", found->unused_labels.size(),
                    c3d->labels.size(), list_of(found->unused_labels));
  return out;
}

/// BVH does not state its unit, so a wrong one shows in nothing but the size of the people.
Result<void> check_size(const motion::Motion& motion, const std::string& origin) {
  for (const auto& body : motion.frames) {
    const Joint& hip = body[JointId::HipLeft];
    const Joint& knee = body[JointId::KneeLeft];
    if (!hip.seen() || !knee.seen()) continue;
    const double thigh = (hip.position - knee.position).norm();
    if (thigh >= kShortestThigh && thigh <= kLongestThigh) return {};
    return fail(ErrorCode::Malformed, origin,
                fmt::format("would hold a person with thighs of {:.3g} m: --unit must say whether "
                            "its lengths are cm or m",
                            thigh));
  }
  return {};
}

Result<Captured> captured_bvh(const std::string& text, const std::string& origin, double unit) {
  const auto bvh = motion::parse_bvh(text, origin, unit);
  if (!bvh) return pass(bvh);
  auto motion = motion::motion_from_bvh(*bvh);
  if (!motion) return fail(motion.error().code, origin, to_string(motion.error()));
  if (auto ok = check_size(*motion, origin); !ok) return pass(ok);
  Captured out{"BVH", {std::move(*motion)}, {1}};
  if (motion::Motion& only = out.persons.front(); motion::starts_with_pose(only)) {
    only.frames.erase(only.frames.begin());
    out.notes["repeated"] = "the first frame is a pose and no part of the motion, and was left out";
  }
  return out;
}

Result<Captured> captured_mvnx(const std::string& text, const std::string& origin) {
  const auto mvnx = motion::parse_mvnx(text, origin);
  if (!mvnx) return pass(mvnx);
  auto motion = motion::motion_from_mvnx(*mvnx);
  if (!motion) return fail(motion.error().code, origin, to_string(motion.error()));
  Captured out{"Xsens MVN (MVNX)", {std::move(*motion)}, {1}};
  if (!mvnx->sensors.empty())
    out.notes["sensors"] =
        fmt::format("orientations of {} inertial sensors are not kept", mvnx->sensors.size());
  return out;
}

Result<Captured> captured(const std::filesystem::path& file, MotionFormat format,
                          const ImportOptions& options) {
  const auto bytes = read_bounded(file, options.limits.max_text_bytes);
  if (!bytes) return pass(bytes);
  const std::string origin = file.string();
  switch (format) {
    case MotionFormat::C3d:
      return captured_c3d(*bytes, origin);
    case MotionFormat::Bvh:
      return captured_bvh(*bytes, origin, options.metres_per_unit);
    case MotionFormat::Mvnx:
      break;
  }
  return captured_mvnx(*bytes, origin);
}

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

void add_frames(MotionRecording& out, const Captured& captured, const ImportOptions& options) {
  const motion::Motion& first = captured.persons.front();
  const FloorPlane floor = options.floor.value_or(floor_of_world());
  for (std::size_t f = 0; f < first.frames.size(); ++f) {
    const double ns = static_cast<double>(f) * kNanosecondsPerSecond / first.rate_hz;
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

}  // namespace

Result<MotionRecording> read_motion_file(const std::filesystem::path& file, MotionFormat format,
                                         const ImportOptions& options) {
  const auto sensor = sensor_for(file, options);
  if (!sensor) return pass(sensor);
  auto found = captured(file, format, options);
  if (!found) return pass(found);
  if (found->persons.size() > kMaxBodies)
    return fail(ErrorCode::TooLarge, file.string(), "holds more than 64 persons.");
  const motion::Motion& first = found->persons.front();
  if (!(static_cast<double>(first.frames.size()) / first.rate_hz <= kMaxSeconds))
    return fail(ErrorCode::TooLarge, file.string(),
                fmt::format("holds {} frames at {:.6g} Hz, which is more than a week.",
                            first.frames.size(), first.rate_hz));
  MotionRecording out;
  out.recording.sensor = *sensor;
  out.recording.device = found->device;
  out.recording.floor = options.floor.value_or(floor_of_world());
  out.recording.notes = found->notes;
  out.recording.notes["origin"] = file.filename().string();
  out.recording.notes["joints"] =
      fmt::format("{} of our {} joints are in the file", joints_in(found->persons), kJointCount);
  out.recording.notes["time"] = fmt::format("{:.6g} Hz in the file, no UTC", first.rate_hz);
  add_frames(out, *found, options);
  return out;
}

}  // namespace chorus::importers
