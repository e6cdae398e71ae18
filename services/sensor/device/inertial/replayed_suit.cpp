#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "common/record/cell_stream.h"
#include "services/sensor/device/inertial/inertial_feed.h"

namespace chorus::inertial_device {
namespace {

constexpr Duration kMaxNap = std::chrono::milliseconds(200);
/// Pause between the end of a recording and its beginning, when it is played again and again.
constexpr Duration kBetweenRounds = std::chrono::milliseconds(20);
constexpr double kUnknownRate = 100.0;

/// The instants of one source in a recording, read while they are played.
class InstantTape {
 public:
  InstantTape(std::vector<std::filesystem::path> files, SensorId source)
      : files_(std::move(files)), source_(std::move(source)), stream_(fresh()) {}

  Result<std::optional<inertial::InertialFrame>> next() {
    for (auto item = stream_.next(); true; item = stream_.next()) {
      if (!item) return pass(item);
      if (!*item) return std::nullopt;
      auto* instant = std::get_if<inertial::InertialFrame>(&**item);
      if (instant == nullptr || (!source_.str().empty() && instant->source != source_)) continue;
      if (last_ && instant->captured <= *last_) continue;  // Two sources in one, or a clock set.
      last_ = instant->captured;
      return std::move(*instant);
    }
  }
  void rewind() {
    stream_ = fresh();
    last_.reset();
  }

 private:
  [[nodiscard]] record::CellStream fresh() const {
    record::CellQuery query;
    query.only = source_;
    query.inertial = true;
    return record::CellStream(files_, query);
  }

  std::vector<std::filesystem::path> files_;
  SensorId source_;
  record::CellStream stream_;
  std::optional<Timestamp> last_;
};

class Replayed final : public InertialFeed {
 public:
  Replayed(ReplayedSuit settings, InstantTape tape, sensor_service::HostTime time)
      : settings_(std::move(settings)), tape_(std::move(tape)), time_(std::move(time)) {}

  /// Finds when the recording begins, and its usual rate.
  Result<void> measure() {
    constexpr std::size_t kEnough = 200;
    std::vector<Timestamp> captured;
    while (captured.size() < kEnough) {
      const auto instant = tape_.next();
      if (!instant) return pass(instant);
      if (!*instant) break;
      captured.push_back((*instant)->captured);
    }
    tape_.rewind();
    if (captured.empty())
      return fail(ErrorCode::InvalidArgument, settings_.recording,
                  "holds no topic /inertial/" + settings_.source.str() + "/orientations");
    first_ = captured.front();
    const double span = seconds(captured.back() - captured.front());
    if (span > 0.0) rate_ = static_cast<double>(captured.size() - 1) / span;
    return {};
  }

  [[nodiscard]] std::string label() const override {
    return "replay of " + std::filesystem::path(settings_.recording).filename().string();
  }
  [[nodiscard]] double rate_hz() const override { return rate_ * settings_.speed; }

  [[nodiscard]] Result<void> run(std::stop_token stop, const TakeInstant& take) override {
    std::uint64_t number = 0;
    Timestamp epoch = time_.world->now();
    do {
      Timestamp due = epoch;
      for (auto instant = tape_.next(); true; instant = tape_.next()) {
        if (!instant) return pass(instant);
        if (!*instant) break;
        due = epoch + played((*instant)->captured - first_);
        if (!wait_until(*time_.world, stop, due)) return {};
        take(stamped(std::move(**instant), due, ++number));
      }
      tape_.rewind();
      epoch = std::max(due, time_.world->now()) + kBetweenRounds;
    } while (settings_.loop && !stop.stop_requested());
    return {};
  }

 private:
  [[nodiscard]] Duration played(Duration recorded) const {
    return from_seconds(seconds(recorded) / settings_.speed);
  }
  /// The instant as if it were said at `due`, by the host's clock.
  [[nodiscard]] inertial::InertialFrame stamped(inertial::InertialFrame instant, Timestamp due,
                                                std::uint64_t number) const {
    const Timestamp was = instant.captured;
    instant.sequence = number;
    instant.captured = time_.host.host_time(due);
    for (inertial::InertialReading& each : instant.readings)
      each.captured = instant.captured + played(each.captured - was);
    return instant;
  }

  ReplayedSuit settings_;
  InstantTape tape_;
  sensor_service::HostTime time_;
  Timestamp first_;
  double rate_ = kUnknownRate;
};

}  // namespace

bool wait_until(const Clock& clock, const std::stop_token& stop, Timestamp until) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    const Duration left = until - clock.now();
    if (left <= Duration::zero()) return true;
    never.wait_for(lock, stop, std::min(left, kMaxNap), [] { return false; });
  }
  return false;
}

Result<std::unique_ptr<InertialFeed>> open_replayed_suit(const ReplayedSuit& settings,
                                                         sensor_service::HostTime time) {
  const auto files = record::recording_files(settings.recording);
  if (!files) return pass(files);
  const auto feed_of = [&](const SensorId& source) {
    return std::make_unique<Replayed>(settings, InstantTape(*files, source), time);
  };
  auto own = feed_of(settings.source);
  if (auto ok = own->measure(); ok) return std::unique_ptr<InertialFeed>(std::move(own));
  auto any = feed_of(SensorId{});
  if (auto ok = any->measure(); !ok) return pass(ok);
  return std::unique_ptr<InertialFeed>(std::move(any));
}

}  // namespace chorus::inertial_device
