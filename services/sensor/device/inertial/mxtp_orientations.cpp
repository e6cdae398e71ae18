#include "services/sensor/device/inertial/mxtp_orientations.h"

#include <deque>
#include <span>

#include "common/evaluation/limb_frame.h"
#include "common/inertial/segment_poses.h"
#include "common/suit/mxtp_decoder.h"

namespace chorus::inertial_device {
namespace {

using inertial::InertialFrame;
using inertial::Limb;

class MxtpReader final : public inertial::StreamReader {
 public:
  explicit MxtpReader(int character) : character_(character) {}

  [[nodiscard]] Result<void> take(std::string_view bytes, Timestamp now) override {
    auto pose = decoder_.take(std::span<const char>(bytes.data(), bytes.size()));
    if (!pose) return pass(pose);
    if (!*pose || (*pose)->character != character_) return {};
    if (!fresh_.empty() && fresh_.back().captured == now) fresh_.pop_back();
    InertialFrame& fresh = fresh_.emplace_back();
    if (fresh_.size() > inertial::kMostWaiting) fresh_.pop_front();
    fresh.captured = now;
    for (std::size_t i = 0; i < inertial::kLimbCount; ++i) {
      const auto limb = static_cast<Limb>(i);
      const auto turned = evaluation::limb_from_orientation((*pose)->body, limb);
      if (!turned) continue;
      inertial::InertialReading& reading = fresh.readings.emplace_back();
      reading.sensor = std::string(name_of(limb));
      reading.captured = now;
      reading.limb = limb;
      reading.inertial_from_sensor = turned->world_from_limb;
    }
    return {};
  }

  [[nodiscard]] std::optional<InertialFrame> instant(Timestamp now) override {
    while (!fresh_.empty() && fresh_.front().readings.empty()) fresh_.pop_front();
    if (fresh_.empty()) return std::nullopt;
    InertialFrame out = std::move(fresh_.front());
    fresh_.pop_front();
    if (fresh_.empty()) out.captured = now;
    out.sequence = ++instants_;
    return out;
  }

 private:
  suit::MxtpDecoder decoder_;
  int character_;
  std::deque<InertialFrame> fresh_;
  std::uint64_t instants_ = 0;
};

}  // namespace

std::unique_ptr<inertial::StreamReader> make_mxtp_reader(int character) {
  return std::make_unique<MxtpReader>(character);
}

}  // namespace chorus::inertial_device
