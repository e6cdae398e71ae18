#include "common/importers/datasets/keraal_text.h"

#include <array>

#include <fmt/format.h>

#include "common/importers/datasets/kinect_orientation.h"
#include "common/importers/text_recording.h"
#include "common/importers/text_rows.h"
#include "common/importers/uniform_clock.h"

namespace chorus::importers {
namespace {

constexpr std::size_t kValuesPerJoint = 7;
constexpr std::size_t kValues = kValuesPerJoint * kJointCount;

Result<Skeleton<SensorSpace>> read_joints(const Row& row) {
  Skeleton<SensorSpace> skeleton;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    std::array<double, 3> x{};
    std::array<double, 4> wxyz{};
    const std::size_t first = kValuesPerJoint * j;
    if (const auto read = row.numbers(first, x, kMaxImported); !read) return pass(read);
    if (const auto read = row.numbers(first + 3, wxyz, kMaxQuaternionPart); !read)
      return pass(read);
    skeleton.joints[j] = {{x[0], x[1], x[2]}, orientation_wxyz(wxyz), JointState::Tracked};
  }
  return skeleton;
}

Result<void> read_poses(LineReader& lines, const ImportOptions& options,
                        record::FrameRecording& recording) {
  auto& frames = recording.frames;
  while (const auto line = lines.next_filled()) {
    const auto row = Row::split(lines, *line, ' ', kValues);
    if (!row) return pass(row);
    const auto joints = read_joints(*row);
    if (!joints) return pass(joints);
    if (frames.size() == options.limits.max_frames)
      return lines.malformed(fmt::format("is beyond the {} frames read at most.", frames.size()));
    const Timestamp captured = uniform_instant(options.start, frames.size(), kKinectHz);
    frames.push_back({recording.sensor,
                      frames.size() + 1,
                      captured,
                      captured,
                      {{kOnlyBody, captured, *joints}},
                      options.floor});
  }
  return {};
}

}  // namespace

Result<record::FrameRecording> read_keraal_text(const std::filesystem::path& file,
                                                const ImportOptions& options) {
  return read_text_recording(
      file, options,
      {"Kinect v2 (KERAAL text)",
       {{"time", kUniformTimeNote}, {"states", "none in the file; every joint counts as tracked"}},
       "row",
       read_poses});
}

}  // namespace chorus::importers
