#include "fusion-server/nats/broker.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <random>
#include <thread>
#include <utility>

#include "common/base/log.h"
#include "fusion-server/nats/session.h"

namespace chorus::nats {
namespace {

/// How often a bucket is tried that could not be opened.
constexpr std::chrono::seconds kTryBuckets{1};
constexpr std::chrono::milliseconds kLookEvery{100};

tl::unexpected<Error> not_connected() {
  return fail(ErrorCode::Unavailable, "nats", "there is no connection to a server");
}

}  // namespace

struct Broker::State {
  State(BrokerConfig c, Listening listening) : config(std::move(c)) {
    ear->listening = std::move(listening);
  }

  void run();
  void serve(const std::shared_ptr<Session>& session);
  void tell(std::string words);
  /// False: the broker ends.
  bool wait(Duration duration);
  [[nodiscard]] std::shared_ptr<Session> session() const {
    const std::scoped_lock lock(mutex);
    return current;
  }

  const BrokerConfig config;
  std::shared_ptr<Ear> ear = std::make_shared<Ear>();
  std::atomic<std::uint64_t> published = 0;
  std::atomic<std::uint64_t> dropped = 0;
  mutable std::mutex mutex;
  std::condition_variable ending;
  bool ended = false;                ///< These are guarded by mutex.
  std::shared_ptr<Session> current;  ///< Null: not connected.
  std::string server;
  std::string trouble;
  std::uint64_t connects = 0;
  std::uint64_t missed = 0;  ///< Of the connections that are lost.
  std::jthread thread;
};

bool Broker::State::wait(Duration duration) {
  std::unique_lock lock(mutex);
  return !ending.wait_for(lock, duration, [this] { return ended; });
}

/// Keeps what is wrong, and logs it when it is something else than before.
void Broker::State::tell(std::string words) {
  {
    const std::scoped_lock lock(mutex);
    if (words == trouble) return;
    trouble = words;
  }
  if (!words.empty()) log::warn("the site's server", {{"reason", words}});
}

/// Until the connection is lost or the broker ends.
void Broker::State::serve(const std::shared_ptr<Session>& session) {
  SteadyTime again{};
  while (!session->closed()) {
    const SteadyTime now = std::chrono::steady_clock::now();
    std::string words = session->complaint();
    if (now >= again && !ear->listening.buckets.empty()) {
      const auto looked = session->look();
      if (!looked) again = now + kTryBuckets;
      if (!looked) words = to_string(looked.error());
      tell(std::move(words));
    } else if (again == SteadyTime{}) {
      tell(std::move(words));
    }
    if (!wait(ear->listening.buckets.empty() || now < again ? kLookEvery : Duration{0})) return;
  }
  const std::string words = session->complaint();
  tell(words.empty() ? "the connection was lost" : words);
}

void Broker::State::run() {
  std::minstd_rand random(std::random_device{}());
  std::uniform_real_distribution<double> longer(1.0, 1.5);
  Duration pause = config.least_wait;
  while (true) {
    auto connected = Session::connect(config, ear);
    if (connected) {
      const std::shared_ptr<Session> session = std::move(*connected);
      {
        const std::scoped_lock lock(mutex);
        current = session;
        server = session->server();
        ++connects;
      }
      tell("");
      log::info("connected to the site's server", {{"server", session->server()}});
      pause = config.least_wait;
      serve(session);
      const std::scoped_lock lock(mutex);
      missed += session->missed();
      current.reset();
      server.clear();
    } else {
      tell(to_string(connected.error()));
    }
    if (!wait(from_seconds(seconds(pause) * longer(random)))) return;
    pause = std::min(2 * pause, std::max(config.most_wait, config.least_wait));
  }
}

Broker::Broker(BrokerConfig config, Listening listening)
    : state_(std::make_unique<State>(std::move(config), std::move(listening))) {
  if (state_->config.servers.empty()) return;  // There is none, for ever.
  state_->thread = std::jthread([state = state_.get()] { state->run(); });
}

Broker::~Broker() {
  {
    const std::scoped_lock lock(state_->mutex);
    state_->ended = true;
  }
  state_->ending.notify_all();
  state_->ear->shut();
  if (state_->thread.joinable()) state_->thread.join();
}

bool Broker::publish(const std::string& subject, std::string_view bytes) {
  const auto session = state_->session();
  const bool done = session && session->publish(subject, bytes);
  ++(done ? state_->published : state_->dropped);
  return done;
}

Result<std::string> Broker::request(const std::string& subject, std::string_view bytes) {
  const auto session = state_->session();
  return session ? session->request(subject, bytes) : not_connected();
}

Result<Entry> Broker::get(const std::string& bucket, const std::string& key) {
  const auto session = state_->session();
  return session ? session->get(bucket, key) : not_connected();
}

Result<std::uint64_t> Broker::put(const std::string& bucket, const Entry& entry) {
  const auto session = state_->session();
  return session ? session->put(bucket, entry) : not_connected();
}

Result<std::uint64_t> Broker::update(const std::string& bucket, const Entry& entry) {
  const auto session = state_->session();
  return session ? session->update(bucket, entry) : not_connected();
}

BrokerStatus Broker::status() const {
  BrokerStatus status;
  const State& s = *state_;
  status.published = s.published;
  status.dropped = s.dropped;
  status.received = s.ear->received;
  const std::scoped_lock lock(s.mutex);
  status.connected = s.current != nullptr;
  status.server = s.server;
  status.trouble = s.trouble;
  status.connects = s.connects;
  status.missed = s.missed + (s.current ? s.current->missed() : 0);
  return status;
}

}  // namespace chorus::nats
