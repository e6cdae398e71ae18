#include "fusion-server/mqtt/mqtt_outlet.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include <mosquitto.h>

#include "fusion-server/mqtt/mqtt_encoder.h"

namespace chorus::mqtt {
namespace {

constexpr int kKeepaliveS = 5;
/// Between two attempts to connect; a little longer by chance.
constexpr Duration kBetweenAttempts = std::chrono::seconds(1);
constexpr int kLoopMs = 100;
/// How long the broker may take to hear that we end, in loops.
constexpr int kLastLoops = 10;

/// The library is initialised once and stays so.
void initialise() {
  static const int once = mosquitto_lib_init();
  static_cast<void>(once);
}

struct Free {
  void operator()(mosquitto* client) const { mosquitto_destroy(client); }
};
using Client = std::unique_ptr<mosquitto, Free>;

class MqttOutlet final : public outlet::Outlet {
 public:
  explicit MqttOutlet(const Settings& settings)
      : settings_(settings), least_step_(from_seconds(0.9 / settings.max_rate)) {}

  ~MqttOutlet() override {
    if (!client_) return;
    // Whoever comes later is told so, too; a last will is only for those who end unexpectedly.
    say_status(kOffline);
    {
      const std::scoped_lock lock(mutex_);
      ended_ = true;
    }
    ending_.notify_all();
    mosquitto_disconnect(client_.get());
  }

  Result<void> open();
  [[nodiscard]] std::string_view name() const override { return "mqtt"; }
  void send(const outlet::TrackerFrame& frame) override;
  [[nodiscard]] SinkCounters counters() const override;

 private:
  static void on_connect(mosquitto* client, void* self, int code);
  static void on_disconnect(mosquitto* client, void* self, int code);
  void say_status(std::string_view status);
  void run();
  [[nodiscard]] bool ended() const {
    const std::scoped_lock lock(mutex_);
    return ended_;
  }
  bool say(const std::string& topic, std::string_view payload);
  void say_who_went(const outlet::TrackerFrame& frame);
  void note(std::string words);

  const Settings settings_;
  const Duration least_step_;
  Timestamp sent_{};
  std::set<PersonId> shown_;
  std::atomic<bool> connected_ = false;
  bool refused_ = false;  ///< Of run() and its callbacks.
  std::atomic<std::uint64_t> dropped_ = 0;
  std::atomic<std::uint64_t> failed_ = 0;
  mutable std::mutex mutex_;
  std::condition_variable ending_;
  bool ended_ = false;   ///< Guarded by mutex_.
  std::string trouble_;  ///< Guarded by mutex_.
  Client client_;
  std::jthread thread_;  ///< Last: it ends first.
};

Result<void> MqttOutlet::open() {
  initialise();
  client_.reset(mosquitto_new(nullptr, true, this));
  if (!client_) return fail(ErrorCode::Io, "mqtt", "there is no memory for a client");
  mosquitto* const client = client_.get();
  const std::string topic = status_topic(settings_.topic);
  int code = mosquitto_will_set(client, topic.c_str(), static_cast<int>(kOffline.size()),
                                kOffline.data(), 1, true);
  if (code == MOSQ_ERR_SUCCESS && !settings_.user.empty())
    code = mosquitto_username_pw_set(client, settings_.user.c_str(), settings_.password.c_str());
  if (code == MOSQ_ERR_SUCCESS && !settings_.ca_file.empty())
    code = mosquitto_tls_set(client, settings_.ca_file.c_str(), nullptr, nullptr, nullptr, nullptr);
  if (code != MOSQ_ERR_SUCCESS) {
    client_.reset();
    return fail(ErrorCode::Io, settings_.ca_file.empty() ? "mqtt" : settings_.ca_file,
                mosquitto_strerror(code));
  }
  mosquitto_threaded_set(client, true);
  mosquitto_connect_callback_set(client, &MqttOutlet::on_connect);
  mosquitto_disconnect_callback_set(client, &MqttOutlet::on_disconnect);
  thread_ = std::jthread([this] { run(); });
  return {};
}

/// Not libmosquitto's own thread: that gives up when the first connection is refused at once.
void MqttOutlet::run() {
  std::minstd_rand random(std::random_device{}());
  std::uniform_real_distribution<double> longer(1.0, 1.5);
  mosquitto* const client = client_.get();
  while (!ended()) {
    int code =
        mosquitto_connect_async(client, settings_.server.c_str(), settings_.port, kKeepaliveS);
    for (int left = kLastLoops; code == MOSQ_ERR_SUCCESS && left > 0; left -= ended() ? 1 : 0)
      code = mosquitto_loop(client, kLoopMs, 1);
    connected_ = false;
    if (ended()) return;
    // A refusal in the broker's own words stays.
    if (!refused_) note(mosquitto_strerror(code));
    refused_ = false;
    std::unique_lock lock(mutex_);
    ending_.wait_for(lock, from_seconds(seconds(kBetweenAttempts) * longer(random)),
                     [this] { return ended_; });
  }
}

void MqttOutlet::on_connect(mosquitto* /*client*/, void* self, int code) {
  auto* const outlet = static_cast<MqttOutlet*>(self);
  outlet->refused_ = code != 0;
  if (code != 0) return outlet->note(mosquitto_connack_string(code));
  outlet->note({});
  outlet->connected_ = true;
  outlet->say_status(kOnline);
}

void MqttOutlet::on_disconnect(mosquitto* /*client*/, void* self, int code) {
  auto* const outlet = static_cast<MqttOutlet*>(self);
  const bool was = outlet->connected_.exchange(false);
  if (code != 0 && was) outlet->note(mosquitto_strerror(code));
}

void MqttOutlet::note(std::string words) {
  const std::scoped_lock lock(mutex_);
  trouble_ = std::move(words);
}

void MqttOutlet::say_status(std::string_view status) {
  if (!connected_) return;
  mosquitto_publish(client_.get(), nullptr, status_topic(settings_.topic).c_str(),
                    static_cast<int>(status.size()), status.data(), 1, true);
}

bool MqttOutlet::say(const std::string& topic, std::string_view payload) {
  const int code = mosquitto_publish(client_.get(), nullptr, topic.c_str(),
                                     static_cast<int>(payload.size()), payload.data(), 0, false);
  if (code == MOSQ_ERR_SUCCESS) return true;
  ++failed_;
  note(mosquitto_strerror(code));
  return false;
}

void MqttOutlet::say_who_went(const outlet::TrackerFrame& frame) {
  std::set<PersonId> here;
  for (const outlet::TrackerBody& body : frame.bodies) here.insert(body.person);
  for (const PersonId person : shown_)
    if (!here.contains(person)) say(person_topic(settings_.topic, person), kGone);
  shown_ = std::move(here);
}

void MqttOutlet::send(const outlet::TrackerFrame& frame) {
  const Duration step = frame.instant - sent_;
  if (step >= Duration{0} && step < least_step_) return;
  // What a slow broker has not taken would wait without end in libmosquitto.
  if (!connected_ || mosquitto_want_write(client_.get())) {
    ++dropped_;
    return;
  }
  sent_ = frame.instant;
  for (const outlet::TrackerBody& body : frame.bodies)
    if (!say(person_topic(settings_.topic, body.person), encode(frame, body))) return;
  say_who_went(frame);
}

SinkCounters MqttOutlet::counters() const {
  SinkCounters counters;
  counters.dropped = dropped_;
  counters.failed = failed_;
  counters.clients = connected_ ? 1 : 0;
  const std::scoped_lock lock(mutex_);
  counters.last_failure = trouble_;
  return counters;
}

}  // namespace

void read_settings(ConfigReader& reader, Settings& out) {
  reader.read("server", out.server);
  reader.read("port", out.port, 1, 65535);
  reader.read("user", out.user);
  reader.read("password", out.password);
  reader.read("ca", out.ca_file);
  reader.read("topic", out.topic);
  reader.read("max_rate_hz", out.max_rate, 0.1, 240.0);
  if (!is_topic(out.topic))
    reader.complain("topic", "must be like chorus/SITE/CELL: no wildcard, no empty level");
  if (out.server.empty()) reader.complain("server", "must name the broker's host");
  if (out.user.empty() && !out.password.empty())
    reader.complain("password", "comes without a user");
}

Result<std::unique_ptr<outlet::Outlet>> open_outlet(const Settings& settings,
                                                    const outlet::OutletContext& /*context*/) {
  auto outlet = std::make_unique<MqttOutlet>(settings);
  if (auto opened = outlet->open(); !opened) return pass(opened);
  return outlet;
}

}  // namespace chorus::mqtt
