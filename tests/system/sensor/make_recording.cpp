// `make_recording FILE FRAMES FIRST_MS`: a person who walks along x at 1 m/s in front of one
// sensor, at 25 Hz, from FIRST_MS after a fixed instant; notes say that the set lasts four seconds.
#include <cstdlib>
#include <iostream>

#include "common/record/frame_recording.h"
#include "tests/support/builders.h"

int main(int argc, char** argv) {
  using namespace chorus;
  if (argc != 4) return 2;
  constexpr std::chrono::milliseconds kStep{40};
  const auto pose = testing::ring_sensor(0, 6);
  record::FrameRecording recording;
  recording.sensor = testing::sensor_id("recorded");
  recording.device = "made by a test";
  recording.floor = testing::floor_seen_from(pose);
  recording.notes["set_origin"] = to_iso8601(testing::kStart);
  recording.notes["set_period_ns"] = "4000000000";
  for (int i = 0; i < std::atoi(argv[2]); ++i) {
    const Timestamp t = testing::kStart + std::chrono::milliseconds(std::atoi(argv[3])) + kStep * i;
    const auto person = testing::standing_person({seconds(kStep * i), 0, 0});
    recording.frames.push_back(
        testing::sensor_frame("recorded", t, {testing::body_seen_from(pose, person, t, 7)}));
  }
  const auto ok = record::write_frame_recording(argv[1], recording);
  if (!ok) std::cerr << to_string(ok.error()) << '\n';
  return ok ? 0 : 1;
}
