// One connected client of any protocol: what the server knows about it.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "common/base/duration.h"

namespace chorus::http {

/// Everything runs on the server's only thread.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  explicit Connection(std::string peer_address) : peer_address_(std::move(peer_address)) {}
  virtual ~Connection() = default;

  /// Called when the document that this client waits for or streams has changed.
  virtual void wake() = 0;
  /// Called when the deadline has passed.
  virtual void expire() = 0;
  /// Called when the server is stopping: finish what is under way, begin nothing new.
  virtual void stop() = 0;
  virtual void close() = 0;

  [[nodiscard]] SteadyTime deadline() const { return deadline_; }
  /// True between requests: the connection may be closed to make room for others.
  [[nodiscard]] virtual bool idle() const { return false; }

  /// The account for which limits count this connection: see net::account_of.
  [[nodiscard]] const std::string& peer_address() const { return peer_address_; }
  void charge_to(std::string account) { peer_address_ = std::move(account); }

 protected:
  SteadyTime deadline_{};

 private:
  std::string peer_address_;
};

}  // namespace chorus::http
