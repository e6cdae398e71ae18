#include "fusion-server/publish/vmc/vmc_outlet.h"

#include <optional>
#include <utility>

#include "common/base/duration.h"
#include "fusion-server/publish/datagram_sender.h"
#include "fusion-server/publish/vmc/vmc_encoder.h"

namespace chorus::publish::vmc {
namespace {

class VmcOutlet final : public Outlet {
 public:
  VmcOutlet(const Settings& settings, std::unique_ptr<DatagramSender> sender)
      : settings_(settings), sender_(std::move(sender)) {}

  [[nodiscard]] std::string_view name() const override { return "vmc"; }
  void send(const TrackerFrame& frame) override {
    if (!first_) first_ = frame.instant;
    Content content;
    content.seconds = seconds(frame.instant - *first_);
    content.trackers = settings_.trackers;
    const TrackerBody* body = in_slot(frame, static_cast<std::size_t>(settings_.slot));
    for (const std::vector<char>& datagram : encode(body, content)) sender_->send(datagram);
  }
  [[nodiscard]] SinkCounters counters() const override {
    SinkCounters counters;
    counters.failed = sender_->failed();
    return counters;
  }

 private:
  Settings settings_;
  std::unique_ptr<DatagramSender> sender_;
  std::optional<Timestamp> first_;
};

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) {
  read_targets(reader, out.targets);
  reader.read("slot", out.slot, 0, kMostSlots - 1);
  reader.read("trackers", out.trackers);
}

Result<std::unique_ptr<Outlet>> open_outlet(const Settings& settings) {
  auto sender = DatagramSender::open({.targets = settings.targets});
  if (!sender) return pass(sender);
  return std::make_unique<VmcOutlet>(settings, std::move(*sender));
}

}  // namespace chorus::publish::vmc
