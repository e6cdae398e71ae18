// `recording_probe write FILE` makes a recording with contents known to the test, and
// `recording_probe session FILE` one of a cell; `recording_probe read FILE` prints what our reader
// reads from a file, as JSON.
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/record/cell_writer.h"
#include "tests/support/builders.h"

namespace {

using namespace chorus;
using namespace chorus::record;

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;  // [ns]
constexpr int kFrames = 300;

Result<void> write_known(const char* path) {
  auto writer = RecordingWriter::create(path, {.library = "chorus probe"});
  if (!writer) return pass(writer);
  const auto frames =
      writer->add_channel({"/frame", "chorus.Frame", R"({"type":"object"})", {{"k", "v"}}});
  const auto notes = writer->add_channel({"/notes", "", "", {}});
  if (auto ok = writer->write_metadata("chorus", {{"sensor", "s1"}, {"device", "probe"}}); !ok) {
    return ok;
  }
  for (int i = 0; i < kFrames; ++i) {
    const Timestamp t = from_unix_ns(kStart) + std::chrono::microseconds(33333) * i;
    const std::string text = R"({"sequence":)" + std::to_string(i) + "}";
    const auto channel = i % 100 == 99 ? *notes : *frames;
    const Message message{"", static_cast<std::uint32_t>(i), t, t - std::chrono::milliseconds(1),
                          text};
    if (auto ok = writer->write(channel, message); !ok) return ok;
  }
  return writer->close();
}

/// Writes two seconds of one person seen by two sensors on a ring.
Result<void> write_session(const char* path) {
  auto writer = CellWriter::create(path, {{{"title", "probe"}}, false});
  if (!writer) return pass(writer);
  PlacesChanged places{testing::kStart, R"({"version":1,"verdict":"Good","sensors":{}})", {}};
  for (int s = 0; s < 2; ++s)
    places.places.push_back({"s" + std::to_string(s + 1), testing::ring_sensor(s, 2)});
  if (auto ok = writer->write(places); !ok) return ok;
  for (int i = 0; i < 60; ++i) {
    const Timestamp t = testing::kStart + testing::kFrameInterval * i;
    const auto person = testing::standing_person({0.01 * i, 0, 0}, 0.02 * i);
    for (int s = 0; s < 2; ++s) {
      const auto pose = testing::ring_sensor(s, 2);
      const auto id = testing::sensor_id("s" + std::to_string(s + 1));
      const auto frame =
          testing::sensor_frame(id.str(), t, {testing::body_seen_from(pose, person, t)});
      const RawFrame raw{
          id,
          std::make_shared<const resource::FrameResource>(resource::to_resource(frame)),
          t,
          testing::floor_seen_from(pose),
          {Duration{0}, Duration{0}, std::chrono::milliseconds(1)}};
      if (auto ok = writer->write(raw); !ok) return ok;
    }
    const auto ok = writer->write(
        FusedFrame{t, t, [&] {
                     const auto at_origin = Eigen::Isometry3d::Identity();
                     auto frame = resource::to_resource(testing::sensor_frame(
                         "fusion", t, {testing::body_seen_from(at_origin, person, t)}));
                     frame.space = resource::SpaceKind::World;
                     return frame;
                   }});
    if (!ok) return ok;
  }
  return writer->close();
}

nlohmann::json to_json(const Recording& recording) {
  nlohmann::json out{{"metadata", recording.metadata},
                     {"truncated", recording.truncated},
                     {"notes", recording.notes},
                     {"messages", nlohmann::json::array()}};
  for (const Message& m : recording.messages) {
    out["messages"].push_back({{"topic", m.topic},
                               {"sequence", m.sequence},
                               {"log_time", std::to_string(to_unix_ns(m.log_time))},
                               {"publish_time", std::to_string(to_unix_ns(m.publish_time))},
                               {"text", m.data}});
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view what = argc == 3 ? argv[1] : "";
  if (what == "write" || what == "session") {
    const auto ok = what == "write" ? write_known(argv[2]) : write_session(argv[2]);
    if (!ok) std::cerr << to_string(ok.error()) << '\n';
    return ok ? 0 : 1;
  }
  if (what == "read") {
    const auto recording = read_recording(argv[2]);
    if (!recording) std::cerr << to_string(recording.error()) << '\n';
    if (recording) std::cout << to_json(*recording).dump() << '\n';
    return recording ? 0 : 1;
  }
  std::fputs("usage: recording_probe write|session|read FILE\n", stderr);
  return 2;
}
