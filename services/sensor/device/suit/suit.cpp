#include "services/sensor/device/suit/suit.h"

#include <optional>
#include <utility>

#include "services/sensor/device/suit/suit_source.h"
#include "services/sensor/host_clock.h"

namespace chorus::suit {
namespace {

class Suit final : public FrameSource {
 public:
  Suit(SuitSettings settings, SensorId sensor, std::shared_ptr<const Clock> clock,
       std::unique_ptr<SuitSource> source)
      : settings_(std::move(settings)),
        sensor_(std::move(sensor)),
        clock_(std::move(clock)),
        source_(std::move(source)) {}

  [[nodiscard]] DeviceDescription describe() const override {
    DeviceDescription device;
    device.kind = "suit";
    device.label =
        settings_.label.empty() ? "inertial suit (" + source_->label() + ")" : settings_.label;
    device.depth_camera = std::nullopt;
    device.nominal_rate_hz = settings_.max_rate_hz;
    return device;
  }
  [[nodiscard]] std::vector<std::string> concerns() const override { return source_->concerns(); }
  [[nodiscard]] std::string trouble() const override { return source_->trouble(); }
  [[nodiscard]] Result<void> run(std::stop_token stop, const Sink& sink) override;

 private:
  SuitSettings settings_;
  SensorId sensor_;
  std::shared_ptr<const Clock> clock_;
  std::unique_ptr<SuitSource> source_;
};

Result<void> Suit::run(std::stop_token stop, const Sink& sink) {
  std::optional<SuitFrames> frames;
  std::uint64_t sequence = 0;
  bool begins = false;
  return source_->run(stop, [&](const SuitInstant& instant, bool anew) {
    if (anew || !frames) frames.emplace(sensor_, settings_);
    begins = begins || anew;
    auto frame = frames->next(instant);
    if (!frame) return;
    frame->sequence = ++sequence;
    frame->received = clock_->now();
    sink({std::move(*frame), begins});
    begins = false;
  });
}

}  // namespace

Result<std::unique_ptr<FrameSource>> make_suit(ConfigReader& section,
                                               const sensor_service::DeviceContext& context) {
  SuitSettings settings = read_suit_settings(section);
  auto clock = std::make_shared<sensor_service::ErringClock>(context.time.world, context.time.host);
  auto source = open_suit(settings, clock);
  if (!source) return pass(source);
  return std::make_unique<Suit>(std::move(settings), context.sensor, std::move(clock),
                                std::move(*source));
}

}  // namespace chorus::suit
