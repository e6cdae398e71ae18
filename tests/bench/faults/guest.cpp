#include "tests/bench/faults/guest.h"

#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "common/resource/frame_resource.h"
#include "common/resource/link_lines.h"
#include "common/synthetic/exercise.h"
#include "common/synthetic/scene.h"
#include "common/time/clock.h"
#include "tests/support/builders.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

constexpr std::chrono::nanoseconds kInterval{33'333'333};

synthetic::WalkerScript script_of_the_room() {
  synthetic::WalkerScript script;
  script.reach = 0.5;
  return script;
}

}  // namespace

Skeleton<WorldSpace> person_at(Timestamp instant) {
  static const synthetic::Scene scene{{}, synthetic::make_people(script_of_the_room(), 1), {}};
  return synthetic::truth(scene, 0, instant);
}

Skeleton<WorldSpace> exercising_person_at(Timestamp instant) {
  static const synthetic::Scene scene = [] {
    synthetic::Scene made{{}, synthetic::make_people(script_of_the_room(), 1), {}};
    for (auto& person : made.people) person = synthetic::exercising(std::move(person));
    return made;
  }();
  return synthetic::truth(scene, 0, instant);
}

Eigen::Isometry3d place_of(int index, int count) {
  synthetic::Ring ring;
  ring.count = static_cast<std::size_t>(count);
  return synthetic::ring_place(ring, static_cast<std::size_t>(index));
}

Guest::Said honest(const Eigen::Isometry3d& world_from_sensor, Timestamp now) {
  return {now, {testing::body_seen_from(world_from_sensor, person_at(now), now)}};
}

Guest::Guest(std::string id, Script script) : id_(std::move(id)), script_(std::move(script)) {
  auto router = std::make_shared<http::Router>();
  router->live("/frame", document_);
  server_ = std::make_unique<http::Server>(http::ServerConfig{.policy = resource::answer_policy()},
                                           router);
  if (!server_->start()) std::abort();  // loopback, any port
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

Guest::~Guest() {
  thread_.request_stop();
  thread_.join();
}

void Guest::run(const std::stop_token& stop) {
  const SystemClock clock;
  auto due = std::chrono::steady_clock::now();
  while (!stop.stop_requested()) {
    say(script_(clock.now()));
    due += kInterval;
    std::this_thread::sleep_until(due);
  }
}

void Guest::say(const Said& said) {
  http::DocumentOptions options;
  options.version = std::to_string(++sequence_);
  SensorFrame frame = testing::sensor_frame(id_, said.captured, said.bodies);
  frame.sequence = sequence_;
  const auto shared = std::make_shared<const resource::FrameResource>(resource::to_resource(frame));
  using resource::Format;
  std::vector<http::Variant> variants;
  variants.push_back({"text/turtle", [shared, behind = said.behind] {
                        return write(*shared, Format::Turtle) + behind;
                      }});
  if (said.behind.empty())
    variants.push_back({"application/json", [shared] { return write(*shared, Format::Json); }});
  document_->publish(std::make_shared<const http::Document>(std::move(variants), options));
}

struct RawServer::Impl {
  void accept() {
    while (true) {
      const int socket = ::accept(listening, nullptr, nullptr);
      if (socket < 0) return;
      const std::scoped_lock lock(mutex);
      sockets.push_back(socket);
      threads.emplace_back([this, socket] { conversation(socket); });
    }
  }

  Conversation conversation;
  int listening = ::socket(AF_INET, SOCK_STREAM, 0);
  std::uint16_t port = testing::free_port();
  std::mutex mutex;  ///< Guards the sockets and the threads.
  std::vector<int> sockets;
  std::vector<std::jthread> threads;
  std::jthread acceptor;
};

RawServer::RawServer(Conversation conversation) : impl_(std::make_unique<Impl>()) {
  impl_->conversation = std::move(conversation);
  const sockaddr_in address = testing::loopback(impl_->port);
  constexpr int kBacklog = 64;
  if (::bind(impl_->listening, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(impl_->listening, kBacklog) != 0)
    std::abort();  // the port was free a moment ago
  impl_->acceptor = std::jthread([impl = impl_.get()] { impl->accept(); });
}

RawServer::~RawServer() {
  ::shutdown(impl_->listening, SHUT_RDWR);
  impl_->acceptor.join();
  for (const int socket : impl_->sockets) ::shutdown(socket, SHUT_RDWR);
  impl_->threads.clear();  // joins
  for (const int socket : impl_->sockets) ::close(socket);
  ::close(impl_->listening);
}

std::uint16_t RawServer::port() const { return impl_->port; }

}  // namespace chorus::bench
