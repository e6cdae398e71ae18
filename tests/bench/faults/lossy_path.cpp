#include "tests/bench/faults/lossy_path.h"

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

#include "common/base/duration.h"

namespace chorus::bench {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr const char* kNearEnd = "10.99.0.1";
constexpr const char* kFar = "10.99.0.2";
constexpr const char* kDevice = "lossy";
constexpr std::size_t kPacketBytes = 2048;  // more than a TUN device's 1500
constexpr int kLookMs = 50;

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_ = -1;
};

/// An error that ends with the system's last error message.
tl::unexpected<Error> failed(const char* what) {
  const bool missing = errno == EPERM || errno == EACCES || errno == ENOENT;
  return fail(missing ? ErrorCode::Unsupported : ErrorCode::Io, what, std::strerror(errno));
}

/// Runs `doing` in a thread of its own, so that only this thread enters the namespace.
template <class Doing>
auto in_thread(const Doing& doing) {
  std::optional<std::invoke_result_t<Doing>> out;
  std::thread([&] { out.emplace(doing()); }).join();
  return std::move(*out);
}

ifreq request(const char* device) {
  ifreq out{};
  std::strncpy(out.ifr_name, device, IFNAMSIZ - 1);
  return out;
}

void put_address(ifreq& in, const char* text) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(asio::ip::make_address_v4(text).to_uint());
  std::memcpy(&in.ifr_addr, &address, sizeof address);
}

struct Setting {
  unsigned long order;
  const char* address;
};

/// Gives the device its address and its peer's, and brings it up.
bool configure(const char* mine, const char* opposite) {
  const Descriptor any(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  for (const Setting& each : {Setting{SIOCSIFADDR, mine}, Setting{SIOCSIFDSTADDR, opposite},
                              Setting{SIOCSIFNETMASK, "255.255.255.252"}}) {
    ifreq asked = request(kDevice);
    put_address(asked, each.address);
    if (::ioctl(any.get(), each.order, &asked) != 0) return false;
  }
  ifreq asked = request(kDevice);
  asked.ifr_flags = IFF_UP | IFF_RUNNING;
  return ::ioctl(any.get(), SIOCSIFFLAGS, &asked) == 0;
}

/// A network namespace and the device through which its packets leave.
struct PathEnd {
  Descriptor space;
  Descriptor device;
};

Result<PathEnd> make_end(const char* mine, const char* opposite) {
  if (::unshare(CLONE_NEWNET) != 0) return failed("no network namespace");
  PathEnd end;
  end.space = Descriptor(::open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC));
  end.device = Descriptor(::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (end.space.get() < 0 || end.device.get() < 0) return failed("/dev/net/tun");
  ifreq asked = request(kDevice);
  asked.ifr_flags = IFF_TUN | IFF_NO_PI;
  if (::ioctl(end.device.get(), TUNSETIFF, &asked) != 0 || !configure(mine, opposite))
    return failed("a TUN device");
  return end;
}

/// A TCP socket that stays in the end's namespace, whichever thread uses it.
Result<int> socket_in(const PathEnd& end) {
  return in_thread([&]() -> Result<int> {
    if (::setns(end.space.get(), CLONE_NEWNET) != 0) return failed("setns");
    const int made = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (made < 0) return failed("socket");
    return made;
  });
}

/// Packets of one direction that are in transit.
class Way {
 public:
  Way(int from, int to) : from_(from), to_(to) {}

  [[nodiscard]] int from() const { return from_; }
  [[nodiscard]] std::optional<SteadyClock::time_point> due() const {
    if (under_way_.empty()) return std::nullopt;
    return under_way_.front().due;
  }
  template <class IsLost>
  void take(SteadyClock::time_point due, const IsLost& is_lost) {
    std::array<char, kPacketBytes> packet{};
    for (;;) {
      const ssize_t size = ::read(from_, packet.data(), packet.size());
      if (size <= 0) return;
      if (!is_lost()) under_way_.push_back({due, {packet.data(), static_cast<std::size_t>(size)}});
    }
  }
  /// Writes the packets that are due; one that the device does not accept is lost, as in a full
  /// queue.
  void hand_on(SteadyClock::time_point now) {
    for (; !under_way_.empty() && under_way_.front().due <= now; under_way_.pop_front()) {
      const std::string& bytes = under_way_.front().bytes;
      [[maybe_unused]] const auto written = ::write(to_, bytes.data(), bytes.size());
    }
  }

 private:
  struct Packet {
    SteadyClock::time_point due;
    std::string bytes;
  };
  int from_;
  int to_;
  std::deque<Packet> under_way_;
};

}  // namespace

struct LossyPath::Impl {
  void carry(const std::stop_token& stop);
  [[nodiscard]] int wait_ms(SteadyClock::time_point now) const;

  PacketModel model;
  PathEnd near;
  PathEnd far;
  std::atomic<bool> losing{false};
  std::array<Way, 2> ways{Way{-1, -1}, Way{-1, -1}};
  std::jthread thread;  // destroyed first
};

int LossyPath::Impl::wait_ms(SteadyClock::time_point now) const {
  int out = kLookMs;
  for (const Way& way : ways) {
    const auto due = way.due();
    if (!due) continue;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(*due - now).count();
    out = std::clamp(static_cast<int>(left), 0, out);
  }
  return out;
}

void LossyPath::Impl::carry(const std::stop_token& stop) {
  std::mt19937 random(1);
  std::bernoulli_distribution draw(model.loss);
  const auto is_lost = [&] { return losing && draw(random); };
  const auto delay = from_seconds(model.delay);
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> asked{pollfd{ways[0].from(), POLLIN, 0},
                                pollfd{ways[1].from(), POLLIN, 0}};
    ::poll(asked.data(), asked.size(), wait_ms(SteadyClock::now()));
    for (Way& way : ways) {
      way.take(SteadyClock::now() + delay, is_lost);
      way.hand_on(SteadyClock::now());
    }
  }
}

LossyPath::LossyPath() : impl_(std::make_unique<Impl>()) {}
LossyPath::~LossyPath() = default;

Result<std::unique_ptr<LossyPath>> LossyPath::open(const PacketModel& model) {
  auto near = in_thread([] { return make_end(kNearEnd, kFar); });
  if (!near) return pass(near);
  auto far = in_thread([] { return make_end(kFar, kNearEnd); });
  if (!far) return pass(far);
  std::unique_ptr<LossyPath> path(new LossyPath);
  Impl& impl = *path->impl_;
  impl.model = model;
  impl.near = std::move(*near);
  impl.far = std::move(*far);
  const int a = impl.near.device.get();
  const int b = impl.far.device.get();
  impl.ways = {Way{a, b}, Way{b, a}};
  impl.thread = std::jthread([&impl](const std::stop_token& stop) { impl.carry(stop); });
  return path;
}

asio::ip::address_v4 LossyPath::far_address() { return asio::ip::make_address_v4(kFar); }

Result<net::Acceptor> LossyPath::listen_far(asio::io_context& io) const {
  const auto made = socket_in(impl_->far);
  if (!made) return pass(made);
  net::Acceptor acceptor(io);
  net::error_code refused;
  acceptor.assign(net::tcp::v4(), *made, refused);
  if (!refused) acceptor.bind({far_address(), 0}, refused);
  if (!refused) acceptor.listen(asio::socket_base::max_listen_connections, refused);
  if (refused) return fail(ErrorCode::Io, "the far end", refused.message());
  return acceptor;
}

Result<net::Socket> LossyPath::near_socket(asio::io_context& io) const {
  const auto made = socket_in(impl_->near);
  if (!made) return pass(made);
  net::Socket socket(io);
  net::error_code refused;
  socket.assign(net::tcp::v4(), *made, refused);
  if (refused) return fail(ErrorCode::Io, "the near end", refused.message());
  return socket;
}

void LossyPath::lose(bool losing) { impl_->losing = losing; }

}  // namespace chorus::bench
