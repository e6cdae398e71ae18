// Reads any lines as what a program pushes: each is read, or refused with a message, and what is
// read is a frame that may be published.  After a whole session of them, during which the clocks
// advance, the desk still reports its state.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "services/sensor/device/bridge/push_dialogue.h"
#include "tests/fuzz/frame_checks.h"

namespace {

using namespace chorus;
using namespace chorus::bridge;
using namespace chorus::fuzz;

constexpr Timestamp kStart = from_unix_ns(1'795'246'200'000'000'000);
constexpr auto kBetween = std::chrono::milliseconds(9);

void check_frame(const SensorFrame& frame) {
  check_bodies(frame.bodies, frame.captured);
  if (frame.floor) require(frame.floor->normal.allFinite() && frame.floor->offset >= 0.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto clock = std::make_shared<FakeClock>(kStart);
  auto steady = std::make_shared<SteadyTime>(std::chrono::hours(1));
  DeskOptions options;
  options.sensor = *SensorId::parse("s1");
  options.clock = clock;
  options.steady_now = [steady] { return *steady; };
  const auto desk = std::make_shared<PushDesk>(std::move(options));
  auto talk = open_dialogue(desk, "WebSocket", "127.0.0.1");
  require(talk.has_value());
  bool over = false;
  while (!text.empty() && !over) {
    const http::Reply heard = (*talk)->hear(next_line(text));
    clock->advance(kBetween);
    *steady += kBetween;
    over = heard.over || (*talk)->look().over;
    for (const auto& one : desk->pushed(Duration{0})) {
      if (const auto* capture = std::get_if<Capture>(&one)) check_frame(capture->frame);
    }
  }
  talk->reset();
  require(!desk->status().state.empty());
  return 0;
}
