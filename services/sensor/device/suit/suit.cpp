#include "services/sensor/device/suit/suit.h"

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "common/base/rate_report.h"
#include "common/suit/mxtp_decoder.h"
#include "common/suit/suit_file.h"
#include "services/sensor/device/suit/suit_clock.h"
#include "services/sensor/device/suit/suit_frames.h"
#include "services/sensor/device/suit/suit_receiver.h"
#include "services/sensor/device/suit/suit_settings.h"
#include "services/sensor/host_clock.h"

namespace chorus::suit {
namespace {

using ClockPointer = std::shared_ptr<const Clock>;

DeviceDescription description(const SuitSettings& settings, const std::string& label) {
  DeviceDescription device;
  device.kind = "suit";
  device.label = settings.label.empty() ? label : settings.label;
  device.depth_camera = std::nullopt;
  device.nominal_rate_hz = settings.max_rate_hz;
  return device;
}

class StreamedSuit final : public FrameSource {
 public:
  StreamedSuit(SuitSettings settings, SensorId sensor, ClockPointer clock)
      : settings_(std::move(settings)), sensor_(std::move(sensor)), clock_(std::move(clock)) {}

  [[nodiscard]] DeviceDescription describe() const override {
    const char* transport = settings_.transport == Transport::Udp ? "UDP" : "TCP";
    return description(settings_, fmt::format("inertial suit (MVN stream, {} {}:{})", transport,
                                              settings_.address, settings_.port));
  }
  [[nodiscard]] std::vector<std::string> concerns() const override {
    const auto receiver = SuitReceiver::open(settings_, [](std::span<const char>) {});
    if (!receiver) return {to_string(receiver.error())};
    return {};
  }
  [[nodiscard]] std::string trouble() const override;
  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;

 private:
  SuitSettings settings_;
  SensorId sensor_;
  ClockPointer clock_;
  std::atomic<std::int64_t> last_ns_ = 0;  ///< When a pose came.
  std::atomic<int> other_ = -1;            ///< A character that is streamed but not wanted.
};

std::string StreamedSuit::trouble() const {
  constexpr Duration kSilence = std::chrono::seconds(2);
  const std::int64_t last = last_ns_;
  if (clock_->now() - from_unix_ns(last) < kSilence) return {};
  if (const int other = other_; other >= 0)
    return fmt::format("the stream has person {}, not {} (device.suit.character)", other,
                       settings_.character);
  return fmt::format("no pose comes; let MVN stream quaternions (type 02) to port {} by {}",
                     settings_.port, settings_.transport == Transport::Udp ? "UDP" : "TCP");
}

Result<void> StreamedSuit::run(std::stop_token stop, const Sink& sink) {
  MxtpDecoder decoder;
  SuitFrames frames(sensor_, settings_);
  SuitClock suit_clock(settings_.latency);
  RateReport refused("suit datagram refused");
  auto receiver = SuitReceiver::open(settings_, [&](std::span<const char> datagram) {
    const auto pose = decoder.take(datagram);
    if (!pose) refused.hit(to_string(pose.error()));
    if (!pose || !*pose) return;
    if ((*pose)->character != settings_.character) {
      other_ = (*pose)->character;
      return;
    }
    const Timestamp now = clock_->now();
    last_ns_ = to_unix_ns(now);
    const Duration stated = std::chrono::milliseconds((*pose)->time_ms);
    auto frame =
        frames.next({pose_of((*pose)->body, stated), (*pose)->body[JointId::SpineBase].position,
                     suit_clock.captured(stated, now)});
    if (!frame) return;
    frame->received = now;
    sink({std::move(*frame)});
  });
  if (!receiver) return pass(receiver);
  (*receiver)->run(stop);
  return {};
}

class FiledSuit final : public FrameSource {
 public:
  FiledSuit(SuitSettings settings, SensorId sensor, ClockPointer clock, SuitTake take)
      : settings_(std::move(settings)),
        sensor_(std::move(sensor)),
        clock_(std::move(clock)),
        take_(std::move(take)) {}

  [[nodiscard]] DeviceDescription describe() const override {
    return description(
        settings_,
        "inertial suit (" + std::filesystem::path(settings_.file).filename().string() + ")");
  }
  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;

 private:
  [[nodiscard]] bool wait_until(const std::stop_token& stop, Timestamp due) const;
  [[nodiscard]] bool play(Timestamp begin, const std::stop_token& stop, const Sink& sink);

  SuitSettings settings_;
  SensorId sensor_;
  ClockPointer clock_;
  SuitTake take_;
  std::uint64_t sequence_ = 0;
};

bool FiledSuit::wait_until(const std::stop_token& stop, Timestamp due) const {
  constexpr Duration kMaxNap = std::chrono::milliseconds(50);
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    const Duration left = due - clock_->now();
    if (left <= Duration::zero()) return true;
    never.wait_for(lock, stop, std::min(left, kMaxNap), [] { return false; });
  }
  return false;
}

/// Plays the take once; false when stopped.
bool FiledSuit::play(Timestamp begin, const std::stop_token& stop, const Sink& sink) {
  SuitFrames frames(sensor_, settings_);
  for (std::size_t i = 0; i < take_.poses.size(); ++i) {
    const SuitPose& pose = take_.poses[i];
    auto frame = frames.next({pose, take_.claimed[i], begin + pose.time});
    if (!frame) continue;
    if (!wait_until(stop, frame->captured + settings_.latency)) return false;
    frame->sequence = ++sequence_;
    frame->received = clock_->now();
    sink({std::move(*frame), i == 0});
  }
  return true;
}

Result<void> FiledSuit::run(std::stop_token stop, const Sink& sink) {
  const Duration step = from_seconds(1.0 / take_.rate_hz);
  Timestamp begin = clock_->now();
  while (play(begin, stop, sink) && settings_.loop) begin += take_.poses.back().time + step;
  return {};
}

}  // namespace

Result<std::unique_ptr<FrameSource>> make_suit(ConfigReader& section,
                                               const sensor_service::DeviceContext& context) {
  SuitSettings settings = read_suit_settings(section);
  auto clock = std::make_shared<sensor_service::ErringClock>(context.time.world, context.time.host);
  if (settings.file.empty())
    return std::make_unique<StreamedSuit>(std::move(settings), context.sensor, std::move(clock));
  auto take = read_suit_file(settings.file, {.stature = settings.stature});
  if (!take) return pass(take);
  settings.stature = 0.0;  // The take has been scaled.
  return std::make_unique<FiledSuit>(std::move(settings), context.sensor, std::move(clock),
                                     std::move(*take));
}

}  // namespace chorus::suit
