// One viewer that speaks foxglove.websocket.v1, as a dialogue: gets the newest message of every
// channel that it subscribed to, each once.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "common/http/dialogue.h"
#include "common/http/router.h"
#include "fusion-server/foxglove/desk.h"

namespace chorus::foxglove {

class ViewerDialogue final : public http::Dialogue {
 public:
  /// `desk` must outlive the dialogue.
  ViewerDialogue(const Desk& desk, std::string name, std::string session);

  [[nodiscard]] http::Reply hear(std::string_view message) override;
  [[nodiscard]] http::Reply look() override;
  [[nodiscard]] http::Reply end(const Error& why) override;

 private:
  struct Subscription {
    std::uint32_t channel = 0;
    std::uint64_t version = 0;  ///< Of the last message that was sent.
  };

  const Desk& desk_;
  std::string name_;
  std::string session_;
  bool greeted_ = false;
  std::uint32_t advertised_ = 0;  ///< The highest id of a channel that the viewer knows.
  std::map<std::uint32_t, Subscription> subscriptions_;
};

/// WebSockets at /foxglove; reading needs no more than Role::Read.  `desk` must outlive the router.
void add_route(http::Router& router, const Desk& desk, const std::string& name,
               const std::string& session);

}  // namespace chorus::foxglove
