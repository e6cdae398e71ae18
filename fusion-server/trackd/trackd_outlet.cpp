#include "fusion-server/trackd/trackd_outlet.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "fusion-server/trackd/shared_segment.h"

namespace chorus::trackd {
namespace {

constexpr int kMaxTrackdSensors = 25 * outlet::kMaxSlots;

class TrackdOutlet final : public outlet::Outlet {
 public:
  TrackdOutlet(LengthUnit unit, std::size_t things, SharedSegment tracker, SharedSegment controller)
      : unit_(unit),
        things_(things),
        tracker_(std::move(tracker)),
        controller_(std::move(controller)) {}

  /// Makes readers that stay attached see nobody, not the last pose for ever.
  ~TrackdOutlet() override { write_sensors({}, unit_, tracker_.bytes(), things_); }

  [[nodiscard]] std::string_view name() const override { return "trackd"; }
  void send(const outlet::TrackerFrame& frame) override {
    write_sensors(frame, unit_, tracker_.bytes(), things_);
    // The time stamp announces the sensors, so it must be written after them.
    std::atomic_thread_fence(std::memory_order_release);
    write_stamp(frame.instant, tracker_.bytes());
  }
  [[nodiscard]] SinkCounters counters() const override { return {}; }

 private:
  LengthUnit unit_;
  std::size_t things_;
  SharedSegment tracker_;
  SharedSegment controller_;
};

Result<SharedSegment> segment_of(int key, const std::vector<char>& content) {
  auto segment = SharedSegment::create(key, content.size());
  if (segment) std::copy(content.begin(), content.end(), segment->bytes().begin());
  return segment;
}

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) {
  constexpr int kMaxKey = 0x7FFF'FFFF;
  reader.read("tracker_key", out.tracker_key, 1, kMaxKey);
  reader.read("controller_key", out.controller_key, 1, kMaxKey);
  if (out.tracker_key == out.controller_key) {
    reader.complain("controller_key", "must differ from tracker_key");
  }
  reader.read("sensors", out.sensors, 1, kMaxTrackdSensors);
  auto unit = static_cast<std::size_t>(out.unit);
  reader.read_choice("unit", unit, {"feet", "metres"});
  out.unit = static_cast<LengthUnit>(unit);
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& context) {
  const std::size_t things = context.props.size();
  const std::size_t sensors = static_cast<std::size_t>(settings.sensors) + things;
  auto tracker = segment_of(settings.tracker_key, tracker_block(sensors));
  if (!tracker) return pass(tracker);
  auto controller = segment_of(settings.controller_key, controller_block());
  if (!controller) return pass(controller);
  return std::make_unique<TrackdOutlet>(settings.unit, things, std::move(*tracker),
                                        std::move(*controller));
}

}  // namespace chorus::trackd
