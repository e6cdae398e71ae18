#include "fusion-server/poll/poller.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "common/base/log.h"
#include "common/net/asio.h"
#include "common/net/event_loop.h"
#include "fusion-server/poll/follower.h"

namespace chorus::poll {

struct Poller::Impl {
  explicit Impl(PollerOptions o) : options(std::move(o)), work(asio::make_work_guard(io)) {
    thread = std::thread([this] { net::run_events(io, "poll handler failed"); });
  }

  ~Impl() { stop(); }

  void stop() {
    if (!thread.joinable()) return;
    {
      const std::scoped_lock lock(mutex);
      for (auto& [id, follower] : followers) {
        asio::post(io, [follower = follower] { follower->stop(); });
      }
    }
    asio::post(io, [this] { io.stop(); });  // After the followers have stopped.
    thread.join();
  }

  void add(PolledSensor sensor) {
    auto url = http::parse_url(sensor.url);
    if (!url) {  // The configuration reader has checked it.
      log::error("sensor not polled",
                 {{"sensor", sensor.id.str()}, {"reason", url.error().message}});
      return;
    }
    const SensorId id = sensor.id;
    auto follower = std::make_shared<Follower>(io, std::move(sensor), std::move(*url), options);
    asio::post(io, [follower] { follower->start(); });
    followers.emplace(id, std::move(follower));
  }

  const PollerOptions options;
  asio::io_context io{1};
  asio::executor_work_guard<net::Executor> work;
  mutable std::mutex mutex;
  std::map<SensorId, std::shared_ptr<Follower>> followers;
  std::thread thread;
};

Poller::Poller(PollerOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Poller::~Poller() = default;
void Poller::stop() { impl_->stop(); }

void Poller::poll(std::vector<PolledSensor> sensors) {
  const std::scoped_lock lock(impl_->mutex);
  for (auto it = impl_->followers.begin(); it != impl_->followers.end();) {
    const PolledSensor current = it->second->report({}).sensor;
    if (std::find(sensors.begin(), sensors.end(), current) != sensors.end()) {
      ++it;
      continue;
    }
    asio::post(impl_->io, [follower = it->second] { follower->stop(); });
    it = impl_->followers.erase(it);
  }
  for (PolledSensor& sensor : sensors) {
    if (!impl_->followers.contains(sensor.id)) impl_->add(std::move(sensor));
  }
}

std::vector<PollReport> Poller::reports() const {
  const Timestamp now = impl_->options.clock->now();
  const std::scoped_lock lock(impl_->mutex);
  std::vector<PollReport> all;
  all.reserve(impl_->followers.size());
  for (const auto& [id, follower] : impl_->followers) all.push_back(follower->report(now));
  return all;
}

}  // namespace chorus::poll
