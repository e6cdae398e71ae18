#include "fusion-server/outlet/datagram_outlet.h"

#include <utility>

#include "fusion-server/outlet/datagram_sender.h"

namespace chorus::outlet {
namespace {

class DatagramOutlet final : public Outlet {
 public:
  DatagramOutlet(std::string_view name, std::unique_ptr<DatagramSender> sender,
                 DatagramEncoder encode)
      : name_(name), sender_(std::move(sender)), encode_(std::move(encode)) {}

  [[nodiscard]] std::string_view name() const override { return name_; }
  void send(const TrackerFrame& frame) override {
    for (const std::vector<char>& datagram : encode_(frame)) sender_->send(datagram);
  }
  [[nodiscard]] SinkCounters counters() const override {
    SinkCounters counters;
    counters.failed = sender_->failed();
    return counters;
  }

 private:
  std::string_view name_;
  std::unique_ptr<DatagramSender> sender_;
  DatagramEncoder encode_;
};

}  // namespace

Result<std::unique_ptr<Outlet>> open_datagram_outlet(std::string_view name,
                                                     const std::vector<std::string>& targets,
                                                     DatagramEncoder encode) {
  auto sender = DatagramSender::open({.targets = targets});
  if (!sender) return pass(sender);
  return std::make_unique<DatagramOutlet>(name, std::move(*sender), std::move(encode));
}

}  // namespace chorus::outlet
