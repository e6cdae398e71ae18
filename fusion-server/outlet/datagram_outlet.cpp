#include "fusion-server/outlet/datagram_outlet.h"

#include <utility>

#include "fusion-server/outlet/datagram_sender.h"

namespace chorus::outlet {
namespace {

struct OpenStream {
  DatagramStream stream;
  std::unique_ptr<DatagramSender> sender;

  void send(const Datagrams& datagrams) const {
    for (const std::vector<char>& datagram : datagrams) sender->send(datagram);
  }
};

class DatagramOutlet final : public Outlet {
 public:
  DatagramOutlet(std::string_view name, std::vector<OpenStream> streams)
      : name_(name), streams_(std::move(streams)) {}
  ~DatagramOutlet() override {
    for (const OpenStream& open : streams_) open.send(open.stream.last_words);
  }

  [[nodiscard]] std::string_view name() const override { return name_; }
  void send(const TrackerFrame& frame) override {
    for (const OpenStream& open : streams_) open.send(open.stream.encode(frame));
  }
  [[nodiscard]] SinkCounters counters() const override {
    SinkCounters counters;
    for (const OpenStream& open : streams_) counters.failed += open.sender->failed();
    return counters;
  }

 private:
  std::string_view name_;
  std::vector<OpenStream> streams_;
};

}  // namespace

Result<std::unique_ptr<Outlet>> open_datagram_outlet(std::string_view name,
                                                     std::vector<DatagramStream> streams) {
  std::vector<OpenStream> opened;
  for (DatagramStream& stream : streams) {
    auto sender = DatagramSender::open({.targets = stream.targets});
    if (!sender) return pass(sender);
    opened.push_back({std::move(stream), std::move(*sender)});
  }
  return std::make_unique<DatagramOutlet>(name, std::move(opened));
}

}  // namespace chorus::outlet
