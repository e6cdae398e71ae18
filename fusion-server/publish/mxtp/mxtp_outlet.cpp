#include "fusion-server/publish/mxtp/mxtp_outlet.h"

#include <utility>

#include "fusion-server/publish/datagram_sender.h"
#include "fusion-server/publish/mxtp/mxtp_encoder.h"

namespace chorus::publish::mxtp {
namespace {

class MxtpOutlet final : public Outlet {
 public:
  explicit MxtpOutlet(std::unique_ptr<DatagramSender> sender) : sender_(std::move(sender)) {}

  [[nodiscard]] std::string_view name() const override { return "mxtp"; }
  void send(const TrackerFrame& frame) override {
    for (const TrackerBody& body : frame.bodies) {
      const std::vector<char> datagram = encode(frame, body);
      if (!datagram.empty()) sender_->send(datagram);
    }
  }
  [[nodiscard]] SinkCounters counters() const override {
    SinkCounters counters;
    counters.failed = sender_->failed();
    return counters;
  }

 private:
  std::unique_ptr<DatagramSender> sender_;
};

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) { read_targets(reader, out.targets); }

Result<std::unique_ptr<Outlet>> open_outlet(const Settings& settings) {
  auto sender = DatagramSender::open({.targets = settings.targets});
  if (!sender) return pass(sender);
  return std::make_unique<MxtpOutlet>(std::move(*sender));
}

}  // namespace chorus::publish::mxtp
