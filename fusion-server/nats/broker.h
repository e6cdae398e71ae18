// A connection to a NATS server that comes and goes: subjects, requests, and the key-value store.
//
// Connecting never fails and never waits: a thread of its own connects, and connects anew after a
// loss, at intervals that double and differ by chance, so that a hall of cells does not knock all
// at once.  What is published meanwhile is dropped and counted; nothing is kept for later.  Types
// of libnats stay in session.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/duration.h"
#include "common/base/result.h"

namespace chorus::nats {

struct BrokerConfig {
  std::vector<std::string> servers;  ///< "nats://10.0.0.5:4222"; any of them will do.
  std::string name;                  ///< What the server calls this connection.
  std::string user;                  ///< Empty: without a password.
  std::string password;
  std::string ca_file;  ///< PEM; the server must have a certificate of it.  Empty: no TLS.
  /// Between two attempts to connect: the first time and at most; each is made up to half as long
  /// again by chance.
  Duration least_wait = std::chrono::milliseconds(200);
  Duration most_wait = std::chrono::seconds(1);
  /// For how long a request or the store is waited for.
  Duration patience = std::chrono::milliseconds(500);

  bool operator==(const BrokerConfig&) const = default;
};

/// Valid while the handler runs.
struct Message {
  std::string_view subject;
  std::string_view bytes;
  std::string_view reply;  ///< Where an answer goes; empty: nobody waits for one.
};

/// Runs on a thread of libnats, one message after the other; must not wait.
struct Subscription {
  std::string subject;  ///< May have wildcards: "chorus.hall.*.people".
  std::function<void(const Message&)> handler;
};

/// A key of a bucket.
struct Entry {
  std::string key;
  std::string value;
  std::uint64_t revision = 0;  ///< Of the bucket; larger after each change.
};

/// A bucket of the store whose keys are followed: the handler gets what is there, after every new
/// connection again, and then what changes.  Runs on the broker's thread; must not wait.
struct Watch {
  std::string bucket;
  std::function<void(const Entry&)> handler;
  Duration forget{0};  ///< How long a bucket that we make keeps a value; zero: for ever.
};

/// What is heard on a connection.
struct Listening {
  std::vector<Subscription> subjects;
  std::vector<Watch> buckets;
};

struct BrokerStatus {
  bool connected = false;
  std::string server;          ///< Of the connection, without its password.
  std::string trouble;         ///< Why the last attempt failed, or what the server complained of.
  std::uint64_t connects = 0;  ///< Connections that were made.
  std::uint64_t published = 0;
  std::uint64_t dropped = 0;  ///< Messages that were not published: there was no connection.
  std::uint64_t received = 0;
  /// Messages that the server had for us and that libnats dropped, because we were too slow.
  std::uint64_t missed = 0;
};

/// Thread-safe.
class Broker {
 public:
  Broker(BrokerConfig config, Listening listening);
  /// No handler runs any more when it returns.
  ~Broker();

  /// False: it was dropped.
  bool publish(const std::string& subject, std::string_view bytes);
  /// The first answer.  Unavailable: nobody is connected, or nobody answers in time.
  [[nodiscard]] Result<std::string> request(const std::string& subject, std::string_view bytes);

  // The store.  Buckets are made when they are first used.  Unavailable: the server, or its
  // JetStream, does not answer.

  /// NotFound: there is no such key.
  [[nodiscard]] Result<Entry> get(const std::string& bucket, const std::string& key);
  /// The new revision.
  Result<std::uint64_t> put(const std::string& bucket, const Entry& entry);
  /// Compare-and-set: writes if the key's revision still is entry.revision; 0: if there is no such
  /// key.  Conflict: somebody has written since.
  Result<std::uint64_t> update(const std::string& bucket, const Entry& entry);

  [[nodiscard]] BrokerStatus status() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace chorus::nats
