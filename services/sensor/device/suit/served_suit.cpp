#include "services/sensor/device/suit/served_suit.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "common/base/handover.h"
#include "common/client/followers.h"

namespace chorus::suit {
namespace {

using ServedFrame = client::Arrived<resource::FrameResource>;

class ServedSuit final : public SuitSource {
 public:
  ServedSuit(const SuitSettings& settings, std::shared_ptr<const Clock> clock)
      : settings_(settings), clock_(std::move(clock)) {}

  [[nodiscard]] std::string label() const override {
    return fmt::format("{} at {}", settings_.service->id.str(), settings_.service->url);
  }
  [[nodiscard]] std::string trouble() const override {
    const std::lock_guard lock(mutex_);
    return trouble_;
  }
  [[nodiscard]] Result<void> run(const std::stop_token& stop, const Take& take) override;

 private:
  void deliver(const SensorFrame& frame, const Take& take);
  void say(std::string trouble) {
    const std::lock_guard lock(mutex_);
    trouble_ = std::move(trouble);
  }

  SuitSettings settings_;
  std::shared_ptr<const Clock> clock_;
  std::optional<Timestamp> last_{};
  mutable std::mutex mutex_;
  std::string trouble_ = "no frame has come yet";  ///< Guarded by mutex_.
};

void ServedSuit::deliver(const SensorFrame& frame, const Take& take) {
  std::vector<const BodyFrame*> bodies;
  for (const BodyFrame& body : frame.bodies) bodies.push_back(&body);
  std::sort(bodies.begin(), bodies.end(),
            [](const BodyFrame* a, const BodyFrame* b) { return a->id < b->id; });
  const auto wanted = static_cast<std::size_t>(settings_.character);
  if (wanted >= bodies.size())
    return say(fmt::format("{} serves {} bodies; device.suit.character asks for number {}",
                           settings_.service->id.str(), bodies.size(), wanted));
  const SuitInstant instant = instant_of(frame, *bodies[wanted]);
  if (!instant.pose.joints[JointId::SpineBase].seen())
    return say(fmt::format("{} serves joints without SpineBase, or as rays; a suit has points",
                           settings_.service->id.str()));
  if (last_ && instant.captured <= *last_) return;  // Filled in later: too late for a live suit.
  last_ = instant.captured;
  say({});
  take(instant, false);
}

Result<void> ServedSuit::run(const std::stop_token& stop, const Take& take) {
  constexpr std::size_t kQueue = 64;
  constexpr Duration kSuitPatience = std::chrono::milliseconds(200);
  Handover<ServedFrame> inbox(kQueue);
  client::Followers followers({.clock = clock_});
  followers.follow<resource::FrameResource>(
      client::kFrames, {*settings_.service},
      [&](ServedFrame frame) { inbox.give(std::move(frame)); });
  while (!stop.stop_requested()) {
    const auto frames = inbox.take(kSuitPatience);
    for (const ServedFrame& frame : frames) deliver(client::place_in_time(frame), take);
    const auto reports = followers.reports();
    if (frames.empty() && !reports.empty() && !reports.front().last_error.empty())
      say(reports.front().last_error);
  }
  followers.stop();
  return {};
}

}  // namespace

SuitInstant instant_of(const SensorFrame& frame, const BodyFrame& body) {
  Eigen::Isometry3d upright = Eigen::Isometry3d::Identity();
  if (frame.floor)
    upright.linear() =
        Eigen::Quaterniond::FromTwoVectors(frame.floor->normal, Eigen::Vector3d::UnitY())
            .toRotationMatrix();
  Skeleton<WorldSpace> standing = to_world(upright, body.skeleton);
  for (Joint& joint : standing.joints) {
    if (joint.measurement == Measurement::Ray) joint.state = JointState::NotTracked;
  }
  return {pose_of(standing, frame.captured.time_since_epoch()),
          standing[JointId::SpineBase].position, frame.captured};
}

std::unique_ptr<SuitSource> serve_suit(const SuitSettings& settings,
                                       std::shared_ptr<const Clock> clock) {
  return std::make_unique<ServedSuit>(settings, std::move(clock));
}

}  // namespace chorus::suit
