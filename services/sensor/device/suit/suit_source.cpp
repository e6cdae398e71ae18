#include "services/sensor/device/suit/suit_source.h"

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "common/base/rate_report.h"
#include "common/suit/mxtp_decoder.h"
#include "common/suit/suit_file.h"
#include "services/sensor/device/suit/served_suit.h"
#include "services/sensor/device/suit/suit_clock.h"
#include "services/sensor/device/suit/suit_receiver.h"

namespace chorus::suit {
namespace {

using ClockPointer = std::shared_ptr<const Clock>;

class StreamedSuit final : public SuitSource {
 public:
  StreamedSuit(SuitSettings settings, ClockPointer clock)
      : settings_(std::move(settings)), clock_(std::move(clock)) {}

  [[nodiscard]] std::string label() const override {
    return fmt::format("MVN stream, {} {}:{}",
                       settings_.transport == Transport::Udp ? "UDP" : "TCP", settings_.address,
                       settings_.port);
  }
  [[nodiscard]] std::vector<std::string> concerns() const override {
    const auto receiver = SuitReceiver::open(settings_, [](std::span<const char>) {});
    if (!receiver) return {to_string(receiver.error())};
    return {};
  }
  [[nodiscard]] std::string trouble() const override;
  [[nodiscard]] Result<void> run(const std::stop_token& stop, const Take& take) override;

 private:
  void hear(const MxtpPose& pose, SuitClock& suit_clock, const Take& take);

  SuitSettings settings_;
  ClockPointer clock_;
  std::atomic<std::int64_t> last_ns_ = 0;  ///< When a pose came.
  std::atomic<int> other_ = -1;            ///< A character that is streamed but not wanted.
};

std::string StreamedSuit::trouble() const {
  constexpr Duration kSilence = std::chrono::seconds(2);
  if (clock_->now() - from_unix_ns(last_ns_) < kSilence) return {};
  if (const int other = other_; other >= 0)
    return fmt::format("the stream has person {}, not {} (device.suit.character)", other,
                       settings_.character);
  return fmt::format("no pose comes; let MVN stream quaternions (type 02) to port {} by {}",
                     settings_.port, settings_.transport == Transport::Udp ? "UDP" : "TCP");
}

void StreamedSuit::hear(const MxtpPose& pose, SuitClock& suit_clock, const Take& take) {
  if (pose.character != settings_.character) {
    other_ = pose.character;
    return;
  }
  const Timestamp now = clock_->now();
  last_ns_ = to_unix_ns(now);
  const Duration stated = std::chrono::milliseconds(pose.time_ms);
  take({pose_of(pose.body, stated), pose.body[JointId::SpineBase].position,
        suit_clock.captured(stated, now)},
       false);
}

Result<void> StreamedSuit::run(const std::stop_token& stop, const Take& take) {
  MxtpDecoder decoder;
  SuitClock suit_clock(settings_.latency);
  RateReport refused("suit datagram refused");
  auto receiver = SuitReceiver::open(settings_, [&](std::span<const char> datagram) {
    const auto pose = decoder.take(datagram);
    if (!pose) refused.hit(to_string(pose.error()));
    if (pose && *pose) hear(**pose, suit_clock, take);
  });
  if (!receiver) return pass(receiver);
  (*receiver)->run(stop);
  return {};
}

class FiledSuit final : public SuitSource {
 public:
  FiledSuit(SuitSettings settings, ClockPointer clock, SuitTake take)
      : settings_(std::move(settings)), clock_(std::move(clock)), take_(std::move(take)) {}

  [[nodiscard]] std::string label() const override {
    return std::filesystem::path(settings_.file).filename().string();
  }
  [[nodiscard]] Result<void> run(const std::stop_token& stop, const Take& take) override;

 private:
  [[nodiscard]] bool wait_until(const std::stop_token& stop, Timestamp due) const;
  [[nodiscard]] bool play(Timestamp begin, const std::stop_token& stop, const Take& take) const;

  SuitSettings settings_;
  ClockPointer clock_;
  SuitTake take_;
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
bool FiledSuit::play(Timestamp begin, const std::stop_token& stop, const Take& take) const {
  for (std::size_t i = 0; i < take_.poses.size(); ++i) {
    const SuitPose& pose = take_.poses[i];
    const Timestamp captured = begin + pose.time;
    if (!wait_until(stop, captured + settings_.latency)) return false;
    take({pose, take_.claimed[i], captured}, i == 0);
  }
  return true;
}

Result<void> FiledSuit::run(const std::stop_token& stop, const Take& take) {
  const Duration step = from_seconds(1.0 / take_.rate_hz);
  Timestamp begin = clock_->now();
  while (play(begin, stop, take) && settings_.loop) begin += take_.poses.back().time + step;
  return {};
}

}  // namespace

Result<std::unique_ptr<SuitSource>> open_suit(const SuitSettings& settings, ClockPointer clock) {
  if (settings.service) return serve_suit(settings, std::move(clock));
  if (settings.file.empty()) return std::make_unique<StreamedSuit>(settings, std::move(clock));
  auto take = read_suit_file(settings.file, {.stature = settings.stature});
  if (!take) return pass(take);
  return std::make_unique<FiledSuit>(settings, std::move(clock), std::move(*take));
}

}  // namespace chorus::suit
