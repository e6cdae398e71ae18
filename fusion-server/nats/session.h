// Internal: one connection to a NATS server, from connecting until it is lost.
#pragma once

#include <atomic>
#include <memory>
#include <shared_mutex>
#include <string>
#include <string_view>

#include "fusion-server/nats/broker.h"

namespace chorus::nats {

/// The handlers of a broker, which threads of libnats call: never once it is shut.
struct Ear {
  Listening listening;
  std::atomic<std::uint64_t> received = 0;
  std::shared_mutex mutex;
  bool open = true;  ///< Guarded by mutex.

  void hear(const Subscription& subscription, const Message& message);
  void hear(const Watch& watch, const Entry& entry);
  /// No handler runs any more when it returns.
  void shut();
};

/// Thread-safe, except look().
class Session {
 public:
  /// Waits two seconds at most for each server.  Unauthorized: the server refuses the password.
  [[nodiscard]] static Result<std::unique_ptr<Session>> connect(const BrokerConfig& config,
                                                                std::shared_ptr<Ear> ear);
  ~Session();

  [[nodiscard]] bool closed() const;
  [[nodiscard]] std::string server() const;
  /// What the server complained of last, such as a subject that it does not permit; empty: nothing.
  [[nodiscard]] std::string complaint() const;
  [[nodiscard]] std::uint64_t missed() const;

  /// Opens the buckets that are followed, and passes on what changed, at most 256 changes of each.
  /// Waits a little for changes.
  /// The error says why a bucket cannot be followed.
  Result<void> look();

  bool publish(const std::string& subject, std::string_view bytes);
  [[nodiscard]] Result<std::string> request(const std::string& subject, std::string_view bytes);
  [[nodiscard]] Result<Entry> get(const std::string& bucket, const std::string& key);
  Result<std::uint64_t> put(const std::string& bucket, const Entry& entry);
  Result<std::uint64_t> update(const std::string& bucket, const Entry& entry);

  struct State;  ///< Private: what libnats holds.

 private:
  explicit Session(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace chorus::nats
