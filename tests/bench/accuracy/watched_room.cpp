#include "tests/bench/accuracy/watched_room.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "fusion-server/pipeline/pipeline.h"

namespace chorus::bench {
namespace {

using synthetic::BodySensor;

constexpr Duration kWatchedEvery = std::chrono::milliseconds(100);
constexpr Duration kWaited = std::chrono::milliseconds(200);  // more than any frame takes

/// The frames of all sensors in the order of their receipt.
class FrameQueue {
 public:
  FrameQueue(std::vector<std::unique_ptr<BodySensor>> sensors, Timestamp end)
      : sensors_(std::move(sensors)), next_(sensors_.size()), end_(end) {
    for (std::size_t i = 0; i < sensors_.size(); ++i) advance(i);
  }

  /// The next frame received before `until`; none when there is none.
  [[nodiscard]] std::optional<SensorFrame> take(Timestamp until) {
    const auto first = std::ranges::min_element(
        next_, [](const auto& a, const auto& b) { return a && (!b || a->received < b->received); });
    if (first == next_.end() || !*first || (*first)->received >= until) return std::nullopt;
    auto frame = std::exchange(*first, std::nullopt);
    advance(static_cast<std::size_t>(first - next_.begin()));
    return frame;
  }

 private:
  void advance(std::size_t i) {
    while (!next_[i] && sensors_[i]->next_exposure() < end_) next_[i] = sensors_[i]->next();
  }

  std::vector<std::unique_ptr<BodySensor>> sensors_;
  std::vector<std::optional<SensorFrame>> next_;
  Timestamp end_;
};

std::vector<std::unique_ptr<BodySensor>> sensors_in(const synthetic::Scene& scene,
                                                    const WatchedSetting& setting, Timestamp from) {
  std::vector<std::unique_ptr<BodySensor>> sensors;
  for (std::size_t i = 0; i < setting.sensors; ++i) {
    synthetic::SensorChoice choice{SensorId::parse(fmt::format("s{}", i + 1)).value(),
                                   i,
                                   setting.profile,
                                   setting.seed,
                                   {},
                                   setting.seed,
                                   setting.seed};
    choice.own_clock = false;
    sensors.push_back(make_sensor(scene, choice, from).value());
  }
  return sensors;
}

}  // namespace

void watch_room(const WatchedSetting& setting, const TakePeople& take) {
  Setting walk;
  walk.profile = setting.profile;
  walk.seed = setting.seed;
  synthetic::Ring ring;
  ring.count = setting.sensors;
  walk.places = ring_places(ring);
  const Workshop workshop = draw_workshop(walk);
  const Registration registration =
      registration::solve(workshop.tracks, workshop.begin, registration::RegistrationConfig{});
  synthetic::Scene scene = workshop.scene;
  synthetic::WalkerScript script;
  script.seed = setting.seed;
  scene.occluders = setting.things;
  if (setting.persons > 1) scene.people = synthetic::make_people(script, setting.persons);

  const Timestamp begin = workshop.begin + std::chrono::seconds(60);
  const Timestamp end = begin + setting.length;
  FrameQueue frames(sensors_in(scene, setting, begin), end + kWaited);
  pipeline::Histories histories;
  pipeline::Memory memory;
  const pipeline::PipelineConfig config;
  std::uint64_t sequence = 1;
  for (Timestamp at = begin + kWaited; at < end; at += kWatchedEvery) {
    while (auto frame = frames.take(at + kWaited)) histories[frame->sensor].push(std::move(*frame));
    auto seen =
        pipeline::perceive({at, at + kWaited, sequence++}, histories, registration, memory, config);
    memory = std::move(seen.memory);
    take(seen.people, at);
  }
}

}  // namespace chorus::bench
