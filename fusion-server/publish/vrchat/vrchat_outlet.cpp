#include "fusion-server/publish/vrchat/vrchat_outlet.h"

#include <utility>

#include "fusion-server/publish/datagram_sender.h"
#include "fusion-server/publish/vrchat/vrchat_encoder.h"

namespace chorus::publish::vrchat {
namespace {

class VrchatOutlet final : public Outlet {
 public:
  VrchatOutlet(const Settings& settings, std::unique_ptr<DatagramSender> sender)
      : settings_(settings), sender_(std::move(sender)) {}

  [[nodiscard]] std::string_view name() const override { return "vrchat"; }
  void send(const TrackerFrame& frame) override {
    const TrackerBody* body = in_slot(frame, static_cast<std::size_t>(settings_.slot));
    if (!body) return;
    for (const std::vector<char>& datagram : encode(*body, {settings_.head})) {
      sender_->send(datagram);
    }
  }
  [[nodiscard]] SinkCounters counters() const override {
    SinkCounters counters;
    counters.failed = sender_->failed();
    return counters;
  }

 private:
  Settings settings_;
  std::unique_ptr<DatagramSender> sender_;
};

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) {
  read_targets(reader, out.targets);
  reader.read("slot", out.slot, 0, kMostSlots - 1);
  reader.read("head", out.head);
}

Result<std::unique_ptr<Outlet>> open_outlet(const Settings& settings) {
  auto sender = DatagramSender::open({.targets = settings.targets});
  if (!sender) return pass(sender);
  return std::make_unique<VrchatOutlet>(settings, std::move(*sender));
}

}  // namespace chorus::publish::vrchat
