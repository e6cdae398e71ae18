// Runs `chorus` in this process and captures its output; makes recordings as its input.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "common/record/frame_recording.h"
#include "services/ctl/line/command.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::ctl {

struct Outcome {
  int code = 0;
  std::string out;
  std::string error;
};

inline Outcome run_chorus(const std::vector<std::string>& words) {
  std::vector<const char*> arguments{"chorus"};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.code =
      run_command_line(all_commands(), static_cast<int>(arguments.size()), arguments.data());
  outcome.out = ::testing::internal::GetCapturedStdout();
  outcome.error = ::testing::internal::GetCapturedStderr();
  return outcome;
}

inline constexpr int kRing = 3;

/// Position at t seconds of a person who walks on a winding path.
inline Eigen::Vector3d walked(double t) {
  return {0.9 * std::sin(0.7 * t), 0.0, 0.8 * std::sin(1.1 * t)};
}

/// What sensor `index` of three on a circle records of the person in `length` seconds.
inline record::FrameRecording walk_seen_by(int index, double length) {
  namespace support = chorus::testing;
  const Eigen::Isometry3d place = support::ring_sensor(index, kRing);
  const std::string name = "s" + std::to_string(index + 1);
  record::FrameRecording recording;
  recording.sensor = support::sensor_id(name);
  recording.device = "test";
  recording.floor = support::floor_seen_from(place);
  for (int i = 0; i < static_cast<int>(30.0 * length); ++i) {
    const double t = i / 30.0;
    const Timestamp captured = support::kStart + i * support::kFrameInterval;
    const auto person = support::standing_person(walked(t), 0.4 * t);
    recording.frames.push_back(
        support::sensor_frame(name, captured, {support::body_seen_from(place, person, captured)}));
    recording.frames.back().floor = recording.floor;
  }
  return recording;
}

/// A folder with the walk, recorded by three sensors.
class Cell {
 public:
  explicit Cell(double length = 6.0) {
    std::filesystem::create_directory(folder_ / "rec");
    for (int i = 0; i < kRing; ++i) {
      auto recording = walk_seen_by(i, length);
      recording.notes["set_origin"] =
          to_iso8601(recording.frames.front().captured);  // their clocks agree
      const auto file = folder_ / "rec" / (recording.sensor.str() + ".mcap");
      EXPECT_THAT(record::write_frame_recording(file, recording), chorus::testing::IsOk());
    }
  }
  [[nodiscard]] std::string recordings() const { return (folder_ / "rec").string(); }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_ / name).string();
  }

 private:
  chorus::testing::TemporaryFolder folder_;
};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end == std::string::npos ? text.size() : end + 1;
  }
  return lines;
}

}  // namespace chorus::ctl
