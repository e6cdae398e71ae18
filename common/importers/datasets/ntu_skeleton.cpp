#include "common/importers/datasets/ntu_skeleton.h"

#include <array>

#include <fmt/format.h>

#include "common/importers/datasets/kinect_orientation.h"
#include "common/importers/text_recording.h"
#include "common/importers/text_rows.h"
#include "common/importers/uniform_clock.h"

namespace chorus::importers {
namespace {

constexpr std::size_t kBodyFields = 10;
constexpr std::size_t kJointFields = 12;
constexpr std::size_t kFirstQuaternionField = 7;  // after x y z and two pixels
constexpr std::size_t kStateField = 11;
constexpr std::uint64_t kMaxKinectBodies = 6;

using IdNumbers = std::map<std::uint64_t, std::uint64_t>;

/// Reads a row that is a single number.
Result<std::uint64_t> read_count(LineReader& lines, std::string_view what) {
  const auto line = lines.next_filled();
  if (!line) return lines.malformed(fmt::format("ends where {} should follow.", what));
  const auto row = Row::split(lines, *line, ' ', 1);
  if (!row) return lines.malformed(fmt::format("should hold {} alone.", what));
  return row->natural(0);
}

Result<Joint> read_joint(LineReader& lines, std::size_t number) {
  const auto line = lines.next_filled();
  if (!line) return lines.malformed(fmt::format("ends before joint {} of 25.", number + 1));
  const auto row = Row::split(lines, *line, ' ', kJointFields);
  if (!row) return pass(row);
  std::array<double, 3> x{};
  std::array<double, 4> wxyz{};
  if (const auto read = row->numbers(0, x, kMaxImported); !read) return pass(read);
  if (const auto read = row->numbers(kFirstQuaternionField, wxyz, kMaxQuaternionPart); !read)
    return pass(read);
  const auto state = row->natural(kStateField);
  if (!state) return pass(state);
  if (*state > 2)
    return lines.malformed(fmt::format("has tracking state {}; 0, 1 and 2 exist.", *state));
  return Joint{{x[0], x[1], x[2]}, orientation_wxyz(wxyz), static_cast<JointState>(*state)};
}

Result<BodyFrame> read_body(LineReader& lines, Timestamp captured, IdNumbers& ids) {
  const auto line = lines.next_filled();
  if (!line) return lines.malformed("ends where a body should follow.");
  const auto row = Row::split(lines, *line, ' ', kBodyFields);
  if (!row) return pass(row);
  const auto id = row->natural(0);
  if (!id) return pass(id);
  const auto joints = read_count(lines, "the joint count");
  if (!joints) return pass(joints);
  if (*joints != kJointCount)
    return lines.malformed(fmt::format("says {} joints; a Kinect v2 body has 25.", *joints));
  BodyFrame body{{ids.try_emplace(*id, ids.size() + 1).first->second}, captured, {}};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto joint = read_joint(lines, j);
    if (!joint) return pass(joint);
    body.skeleton.joints[j] = *joint;
  }
  return body;
}

bool holds_id(const std::vector<BodyFrame>& bodies, BodyId id) {
  for (const BodyFrame& body : bodies) {
    if (body.id == id) return true;
  }
  return false;
}

Result<std::vector<BodyFrame>> read_bodies(LineReader& lines, Timestamp captured, IdNumbers& ids) {
  const auto count = read_count(lines, "the number of bodies");
  if (!count) return pass(count);
  if (*count > kMaxKinectBodies)
    return lines.malformed(fmt::format("says {} bodies; a Kinect v2 tracks six.", *count));
  std::vector<BodyFrame> bodies;
  for (std::uint64_t b = 0; b < *count; ++b) {
    const auto body = read_body(lines, captured, ids);
    if (!body) return pass(body);
    if (holds_id(bodies, body->id))
      return lines.malformed("closes a second body with the same id.");
    bodies.push_back(*body);
  }
  return bodies;
}

Result<void> read_frames(LineReader& lines, const ImportOptions& options,
                         record::FrameRecording& recording) {
  const auto count = read_count(lines, "the number of frames");
  if (!count) return pass(count);
  if (*count > options.limits.max_frames)
    return lines.malformed(
        fmt::format("says {} frames; at most {} are read.", *count, options.limits.max_frames));
  IdNumbers ids;
  for (std::uint64_t i = 0; i < *count; ++i) {
    const Timestamp captured = uniform_instant(options.start, i, kKinectHz);
    auto bodies = read_bodies(lines, captured, ids);
    if (!bodies) return pass(bodies);
    recording.frames.push_back(
        {recording.sensor, i + 1, captured, captured, std::move(*bodies), options.floor});
  }
  if (lines.next_filled())
    return lines.malformed(fmt::format("goes on after the {} frames the first line says.", *count));
  return {};
}

}  // namespace

Result<record::FrameRecording> read_ntu_skeleton(const std::filesystem::path& file,
                                                 const ImportOptions& options) {
  return read_text_recording(
      file, options,
      {"Kinect v2 (NTU .skeleton)",
       {{"time", kUniformTimeNote}, {"bodies", "ids renumbered from 1 in order of appearance"}},
       "frame",
       read_frames});
}

}  // namespace chorus::importers
