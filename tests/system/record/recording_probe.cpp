// `recording_probe write FILE` makes a recording whose contents the test knows; `recording_probe
// read FILE` prints what our reader makes of a file, as JSON.
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/record/recording.h"

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
  if (argc == 3 && std::string_view(argv[1]) == "write") {
    const auto ok = write_known(argv[2]);
    if (!ok) std::cerr << to_string(ok.error()) << '\n';
    return ok ? 0 : 1;
  }
  if (argc == 3 && std::string_view(argv[1]) == "read") {
    const auto recording = read_recording(argv[2]);
    if (!recording) std::cerr << to_string(recording.error()) << '\n';
    if (recording) std::cout << to_json(*recording).dump() << '\n';
    return recording ? 0 : 1;
  }
  std::fputs("usage: recording_probe write|read FILE\n", stderr);
  return 2;
}
