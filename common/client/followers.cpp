#include "common/client/followers.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <thread>

#include "common/base/log.h"
#include "common/client/follower.h"
#include "common/http/client.h"
#include "common/net/asio.h"
#include "common/net/event_loop.h"

namespace chorus::client {
namespace {

using ById = std::map<SensorId, std::shared_ptr<Follower>>;

}  // namespace

struct Followers::Impl {
  explicit Impl(FollowOptions o) : options(std::move(o)), work(asio::make_work_guard(io)) {
    thread = std::thread([this] { net::run_events(io, "poll handler failed"); });
  }

  ~Impl() { stop(); }

  void stop() {
    if (!thread.joinable()) return;
    {
      const std::scoped_lock lock(mutex);
      for (auto& [path, followers] : kinds) {
        for (auto& [id, follower] : followers) end(follower);
      }
    }
    asio::post(io, [this] { io.stop(); });  // After the followers have stopped.
    thread.join();
  }

  void end(std::shared_ptr<Follower> follower) {
    asio::post(io, [follower = std::move(follower)] { follower->stop(); });
  }

  void add(ById& followers, FollowedService service, const Following& following) {
    auto url = http::parse_url(service.url);
    if (!url) {  // The configuration reader has checked it.
      log::error("sensor not polled",
                 {{"sensor", service.id.str()}, {"reason", url.error().message}});
      return;
    }
    const SensorId id = service.id;
    auto follower = std::make_shared<Follower>(io, std::move(service), std::move(*url), following);
    asio::post(io, [follower] { follower->start(); });
    followers.emplace(id, std::move(follower));
  }

  const FollowOptions options;
  asio::io_context io{1};
  asio::executor_work_guard<net::Executor> work;
  mutable std::mutex mutex;
  std::map<std::string_view, ById> kinds;  ///< By DocumentKind::path.
  std::thread thread;
};

Followers::Followers(FollowOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Followers::~Followers() = default;
void Followers::stop() { impl_->stop(); }

void Followers::follow_any(const DocumentKind& kind, std::vector<FollowedService> services,
                           const DeliverAny& deliver) {
  const std::scoped_lock lock(impl_->mutex);
  ById& followers = impl_->kinds[kind.path];
  std::erase_if(followers, [&](const auto& one) {
    const bool goes = std::ranges::find(services, one.second->service()) == services.end();
    if (goes) impl_->end(one.second);
    return goes;
  });
  for (FollowedService& service : services) {
    if (followers.contains(service.id)) continue;
    impl_->add(followers, std::move(service), {kind, impl_->options, deliver});
  }
}

std::vector<FollowReport> Followers::reports(const DocumentKind& kind) const {
  const Timestamp now = impl_->options.clock->now();
  const std::scoped_lock lock(impl_->mutex);
  std::vector<FollowReport> all;
  const auto followers = impl_->kinds.find(kind.path);
  if (followers == impl_->kinds.end()) return all;
  all.reserve(followers->second.size());
  for (const auto& [id, follower] : followers->second) all.push_back(follower->report(now));
  return all;
}

}  // namespace chorus::client
