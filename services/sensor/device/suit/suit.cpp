#include "services/sensor/device/suit/suit.h"

#include <optional>
#include <utility>

#include "services/sensor/device/suit/suit_gloves.h"
#include "services/sensor/device/suit/suit_source.h"
#include "services/sensor/host_clock.h"

namespace chorus::suit {
namespace {

std::shared_ptr<const Clock> clock_of(const sensor_service::DeviceContext& context) {
  return std::make_shared<sensor_service::ErringClock>(context.time.world, context.time.host);
}

class Suit final : public FrameSource {
 public:
  Suit(SuitSettings settings, const sensor_service::DeviceContext& context,
       std::unique_ptr<SuitSource> source, SuitGloves gloves)
      : settings_(std::move(settings)),
        sensor_(context.sensor),
        clock_(clock_of(context)),
        source_(std::move(source)),
        gloves_(std::move(gloves)) {}

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
  SuitGloves gloves_;
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
    for (BodyFrame& body : frame->bodies) body.hands = gloves_.hands(instant, 0.0, body.skeleton);
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
  auto gloves = SuitGloves::open(settings);
  if (!gloves) return pass(gloves);
  auto source = open_suit(settings, clock_of(context));
  if (!source) return pass(source);
  return std::make_unique<Suit>(std::move(settings), context, std::move(*source),
                                std::move(*gloves));
}

}  // namespace chorus::suit
