#include "fusion-server/nats/session.h"

#include <array>
#include <map>
#include <mutex>
#include <utility>

#include <nats/nats.h>

#include "fusion-server/site/site_id.h"

namespace chorus::nats {
namespace {

/// How long connecting may take, and a write to a connection that does not take it [ms].
constexpr std::int64_t kConnectMs = 2000;
constexpr std::int64_t kWriteMs = 1000;
/// A server that does not answer two of these is lost.
constexpr std::int64_t kPingMs = 2000;
constexpr int kPings = 2;
/// What may wait for a handler; what comes then is dropped and counted.
constexpr int kPendingMessages = 256;
constexpr int kPendingBytes = 8 << 20;
/// How long look() waits for changes of a bucket [ms].
constexpr std::int64_t kLookMs = 20;
/// How many changes of a bucket look() passes on before it looks at the next one.
constexpr int kMostChanges = 256;
/// Of a bucket that we make: a value, and all of it [bytes].
constexpr int kValueBytes = 4096;
constexpr std::int64_t kBucketBytes = 16 << 20;

template <class T, void (*Destroy)(T*)>
struct Destroyer {
  void operator()(T* held) const { Destroy(held); }
};
template <class T, void (*Destroy)(T*)>
using Held = std::unique_ptr<T, Destroyer<T, Destroy>>;
using Options = Held<natsOptions, natsOptions_Destroy>;
using Connection = Held<natsConnection, natsConnection_Destroy>;
using Subscribed = Held<natsSubscription, natsSubscription_Destroy>;
using NatsMessage = Held<natsMsg, natsMsg_Destroy>;
using Stream = Held<jsCtx, jsCtx_Destroy>;
using Store = Held<kvStore, kvStore_Destroy>;
using StoreEntry = Held<kvEntry, kvEntry_Destroy>;
using Watcher = Held<kvWatcher, kvWatcher_Destroy>;

std::int64_t milliseconds_of(Duration duration) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(duration).count();
}

/// What libnats says of its last failure on this thread, in one line.
std::string words_for(natsStatus status) {
  natsStatus last = NATS_OK;
  const char* words = nats_GetLastError(&last);
  if (words != nullptr && *words != '\0' && last == status) return words;
  return natsStatus_GetText(status);
}

tl::unexpected<Error> failure(natsStatus status, std::string context) {
  const std::string words = words_for(status);
  if (status == NATS_NOT_FOUND) return fail(ErrorCode::NotFound, std::move(context), words);
  if (status == NATS_CONNECTION_AUTH_FAILED || words.find("uthorization") != std::string::npos)
    return fail(ErrorCode::Unauthorized, std::move(context),
                "the server refuses the user or the password");
  if (words.find("wrong last sequence") != std::string::npos)
    return fail(ErrorCode::Conflict, std::move(context), "somebody else has written since");
  return fail(ErrorCode::Unavailable, std::move(context), words);
}

/// What a subscription of libnats calls back with; deleted when its thread has ended.
struct Listener {
  std::shared_ptr<Ear> ear;
  std::size_t index = 0;
};

void on_message(natsConnection* /*connection*/, natsSubscription* /*subscription*/,
                natsMsg* message, void* closure) {
  const NatsMessage held(message);
  const auto* listener = static_cast<const Listener*>(closure);
  const char* reply = natsMsg_GetReply(message);
  const Message heard{
      natsMsg_GetSubject(message),
      {natsMsg_GetData(message), static_cast<std::size_t>(natsMsg_GetDataLength(message))},
      reply == nullptr ? std::string_view() : reply};
  listener->ear->hear(listener->ear->listening.subjects[listener->index], heard);
}

void on_complete(void* closure) { delete static_cast<Listener*>(closure); }

/// The host of "tls://name:4222"; empty if it is an address.
std::string name_in(const std::string& server) {
  const std::size_t scheme = server.find("://");
  std::string host = server.substr(scheme == std::string::npos ? 0 : scheme + 3);
  host = host.substr(0, host.rfind(':'));
  const bool address = host.find(':') != std::string::npos ||
                       host.find_first_not_of("0123456789.") == std::string::npos;
  return address ? std::string() : host;
}

natsStatus set_connection(natsOptions* options, const BrokerConfig& config) {
  std::vector<const char*> servers;
  for (const std::string& server : config.servers) servers.push_back(server.c_str());
  natsStatus s = natsOptions_SetServers(options, servers.data(), static_cast<int>(servers.size()));
  if (s == NATS_OK) s = natsOptions_SetName(options, config.name.c_str());
  if (s == NATS_OK && !config.user.empty())
    s = natsOptions_SetUserInfo(options, config.user.c_str(), config.password.c_str());
  // Answers come to subjects of this user, which the server can keep from others.
  if (s == NATS_OK && site::CellId::parse(config.user))
    s = natsOptions_SetCustomInboxPrefix(options, ("_INBOX." + config.user).c_str());
  if (s == NATS_OK && !config.ca_file.empty()) {
    s = natsOptions_SetSecure(options, true);
    if (s == NATS_OK) s = natsOptions_LoadCATrustedCertificates(options, config.ca_file.c_str());
    // libnats compares names, not addresses, and one for all servers.
    const std::string name = name_in(config.servers.front());
    if (s == NATS_OK && config.servers.size() == 1 && !name.empty())
      s = natsOptions_SetExpectedHostname(options, name.c_str());
  }
  return s;
}

/// Connecting anew is the broker's, which waits differently each time and keeps nothing for later.
natsStatus set_timings(natsOptions* options) {
  natsStatus s = natsOptions_SetAllowReconnect(options, false);
  if (s == NATS_OK) s = natsOptions_SetTimeout(options, kConnectMs);
  if (s == NATS_OK) s = natsOptions_SetWriteDeadline(options, kWriteMs);
  if (s == NATS_OK) s = natsOptions_SetPingInterval(options, kPingMs);
  if (s == NATS_OK) s = natsOptions_SetMaxPingsOut(options, kPings);
  if (s == NATS_OK) s = natsOptions_SetSendAsap(options, true);
  if (s == NATS_OK) s = natsOptions_SetFailRequestsOnDisconnect(options, true);
  // Without a handler libnats writes the server's complaints to standard error.
  const auto silent = [](natsConnection*, natsSubscription*, natsStatus, void*) {};
  if (s == NATS_OK) s = natsOptions_SetErrorHandler(options, silent, nullptr);
  return s;
}

Entry entry_of(kvEntry* entry) {
  return {kvEntry_Key(entry),
          {static_cast<const char*>(kvEntry_Value(entry)),
           static_cast<std::size_t>(kvEntry_ValueLen(entry))},
          kvEntry_Revision(entry)};
}

}  // namespace

void Ear::hear(const Subscription& subscription, const Message& message) {
  const std::shared_lock lock(mutex);
  if (!open) return;
  ++received;
  subscription.handler(message);
}

void Ear::hear(const Watch& watch, const Entry& entry) {
  const std::shared_lock lock(mutex);
  if (open) watch.handler(entry);
}

void Ear::shut() {
  const std::unique_lock lock(mutex);
  open = false;
}

struct Session::State {
  std::shared_ptr<Ear> ear;
  std::int64_t patience_ms = 0;
  // In this order, because each is destroyed before what it stands on.
  Connection connection;
  Stream stream;
  std::mutex mutex;
  std::map<std::string, Store> stores;  ///< Guarded by mutex; none is removed.
  std::vector<Subscribed> subscriptions;
  std::vector<Watcher> watchers;  ///< As in ear->listening.buckets; null: not yet.

  Result<void> subscribe();
  Result<kvStore*> store(const std::string& bucket);
  Result<void> look(std::size_t index);
};

Result<void> Session::State::subscribe() {
  for (std::size_t i = 0; i < ear->listening.subjects.size(); ++i) {
    const std::string& subject = ear->listening.subjects[i].subject;
    auto listener = std::make_unique<Listener>(Listener{ear, i});
    natsSubscription* made = nullptr;
    const natsStatus s = natsConnection_Subscribe(&made, connection.get(), subject.c_str(),
                                                  on_message, listener.get());
    if (s != NATS_OK) return failure(s, subject);
    natsSubscription_SetOnCompleteCB(made, on_complete, listener.release());
    natsSubscription_SetPendingLimits(made, kPendingMessages, kPendingBytes);
    subscriptions.emplace_back(made);
  }
  return {};
}

/// The bucket, which is made if it is not there.  Two cells may make it at once: then it is there.
Result<kvStore*> Session::State::store(const std::string& bucket) {
  const std::scoped_lock lock(mutex);
  Store& known = stores[bucket];
  if (known) return known.get();
  kvStore* opened = nullptr;
  natsStatus s = js_KeyValue(&opened, stream.get(), bucket.c_str());
  if (s == NATS_NOT_FOUND) {
    kvConfig config;
    kvConfig_Init(&config);
    config.Bucket = bucket.c_str();
    config.MaxValueSize = kValueBytes;
    config.MaxBytes = kBucketBytes;
    for (const Watch& watch : ear->listening.buckets)
      if (watch.bucket == bucket) config.TTL = watch.forget.count();
    s = js_CreateKeyValue(&opened, stream.get(), &config);
    if (s != NATS_OK) s = js_KeyValue(&opened, stream.get(), bucket.c_str());
  }
  if (s != NATS_OK) {
    auto failed = failure(s, bucket);
    // Without the server's key-value store nothing is "not found".
    failed.value().code = ErrorCode::Unavailable;
    return failed;
  }
  known.reset(opened);
  return opened;
}

Result<void> Session::State::look(std::size_t index) {
  const Watch& watch = ear->listening.buckets[index];
  if (!watchers[index]) {
    const auto opened = store(watch.bucket);
    if (!opened) return pass(opened);
    kvWatcher* made = nullptr;
    if (const natsStatus s = kvStore_WatchAll(&made, *opened, nullptr); s != NATS_OK)
      return failure(s, watch.bucket);
    watchers[index].reset(made);
  }
  for (int n = 0; n < kMostChanges; ++n) {
    kvEntry* next = nullptr;
    const natsStatus s = kvWatcher_Next(&next, watchers[index].get(), kLookMs);
    if (s == NATS_TIMEOUT) return {};
    if (s != NATS_OK) {
      watchers[index].reset();
      return failure(s, watch.bucket);
    }
    const StoreEntry held(next);
    if (!held) continue;  // What was there is complete.
    if (kvEntry_Operation(next) == kvOp_Put) ear->hear(watch, entry_of(next));
  }
  return {};
}

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}

Session::~Session() {
  // Nobody waits for what a dead server would still take.
  natsConnection_Close(state_->connection.get());
}

Result<std::unique_ptr<Session>> Session::connect(const BrokerConfig& config,
                                                  std::shared_ptr<Ear> ear) {
  natsOptions* made = nullptr;
  if (const natsStatus s = natsOptions_Create(&made); s != NATS_OK) return failure(s, "nats");
  const Options options(made);
  natsStatus s = set_connection(made, config);
  if (s == NATS_OK) s = set_timings(made);
  if (s != NATS_OK) return failure(s, config.ca_file.empty() ? "servers" : config.ca_file);
  natsConnection* connected = nullptr;
  s = natsConnection_Connect(&connected, made);
  if (s != NATS_OK) return failure(s, config.servers.front());
  auto state = std::make_unique<State>();
  state->ear = std::move(ear);
  state->connection.reset(connected);
  state->patience_ms = milliseconds_of(config.patience);
  state->watchers.resize(state->ear->listening.buckets.size());
  jsOptions stream;
  jsOptions_Init(&stream);
  stream.Wait = state->patience_ms;
  jsCtx* context = nullptr;
  s = natsConnection_JetStream(&context, connected, &stream);
  if (s != NATS_OK) return failure(s, config.servers.front());
  state->stream.reset(context);
  if (auto ok = state->subscribe(); !ok) return pass(ok);
  return std::unique_ptr<Session>(new Session(std::move(state)));
}

bool Session::closed() const { return natsConnection_IsClosed(state_->connection.get()); }

std::string Session::server() const {
  std::array<char, 256> url{};
  natsConnection_GetConnectedUrl(state_->connection.get(), url.data(), url.size());
  std::string text = url.data();
  const std::size_t at = text.find('@');
  const std::size_t start = text.find("://");
  if (at != std::string::npos && start != std::string::npos) text.erase(start + 3, at - start - 2);
  return text;
}

std::string Session::complaint() const {
  const char* words = nullptr;
  const natsStatus s = natsConnection_GetLastError(state_->connection.get(), &words);
  return s == NATS_OK || words == nullptr ? std::string() : words;
}

std::uint64_t Session::missed() const {
  std::uint64_t all = 0;
  for (const Subscribed& each : state_->subscriptions) {
    std::int64_t dropped = 0;
    if (natsSubscription_GetDropped(each.get(), &dropped) == NATS_OK)
      all += static_cast<std::uint64_t>(dropped);
  }
  return all;
}

Result<void> Session::look() {
  Result<void> outcome;
  for (std::size_t i = 0; i < state_->watchers.size(); ++i)
    if (auto looked = state_->look(i); !looked && outcome) outcome = std::move(looked);
  return outcome;
}

bool Session::publish(const std::string& subject, std::string_view bytes) {
  return natsConnection_Publish(state_->connection.get(), subject.c_str(), bytes.data(),
                                static_cast<int>(bytes.size())) == NATS_OK;
}

Result<std::string> Session::request(const std::string& subject, std::string_view bytes) {
  natsMsg* answer = nullptr;
  const natsStatus s =
      natsConnection_Request(&answer, state_->connection.get(), subject.c_str(), bytes.data(),
                             static_cast<int>(bytes.size()), state_->patience_ms);
  if (s != NATS_OK) return failure(s, subject);
  const NatsMessage held(answer);
  return std::string(natsMsg_GetData(answer),
                     static_cast<std::size_t>(natsMsg_GetDataLength(answer)));
}

Result<Entry> Session::get(const std::string& bucket, const std::string& key) {
  const auto opened = state_->store(bucket);
  if (!opened) return pass(opened);
  kvEntry* found = nullptr;
  const natsStatus s = kvStore_Get(&found, *opened, key.c_str());
  if (s != NATS_OK) return failure(s, bucket + "/" + key);
  const StoreEntry held(found);
  return entry_of(found);
}

Result<std::uint64_t> Session::put(const std::string& bucket, const Entry& entry) {
  const auto opened = state_->store(bucket);
  if (!opened) return pass(opened);
  std::uint64_t revision = 0;
  const natsStatus s = kvStore_Put(&revision, *opened, entry.key.c_str(), entry.value.data(),
                                   static_cast<int>(entry.value.size()));
  if (s != NATS_OK) return failure(s, bucket + "/" + entry.key);
  return revision;
}

Result<std::uint64_t> Session::update(const std::string& bucket, const Entry& entry) {
  const auto opened = state_->store(bucket);
  if (!opened) return pass(opened);
  std::uint64_t revision = 0;
  const auto size = static_cast<int>(entry.value.size());
  const natsStatus s =
      entry.revision == 0
          ? kvStore_Create(&revision, *opened, entry.key.c_str(), entry.value.data(), size)
          : kvStore_Update(&revision, *opened, entry.key.c_str(), entry.value.data(), size,
                           entry.revision);
  if (s != NATS_OK) return failure(s, bucket + "/" + entry.key);
  return revision;
}

}  // namespace chorus::nats
