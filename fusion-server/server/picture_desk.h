// /sensors/{id}/image: the newest colour image of a sensor, fetched from it while somebody looks.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "common/client/followers.h"
#include "common/http/router.h"
#include "fusion-server/server/worker.h"

namespace chorus::server {

/// Thread-safe.
class PictureDesk {
 public:
  /// Which service has this id; none: nobody.
  using ServiceOf = std::function<std::optional<client::FollowedService>(const std::string& id)>;
  PictureDesk(std::string run, ServiceOf service_of)
      : run_(std::move(run)), service_of_(std::move(service_of)) {}

  /// The router keeps using this object, which must outlive the router.
  void add_routes(http::Router& router);

 private:
  struct Picture {
    bool asked = false;                          ///< One is on its way.
    http::DocumentPtr document;                  ///< Null: none yet.
    std::string trouble;                         ///< Why there is none.
    std::chrono::steady_clock::time_point at{};  ///< When it came, or was refused.
  };

  [[nodiscard]] Result<http::DocumentPtr> newest(const std::string& id);
  void fetch(const std::string& id, const client::FollowedService& service);

  const std::string run_;
  const ServiceOf service_of_;
  std::mutex mutex_;  ///< Guards the members below.
  std::map<std::string, Picture> pictures_;
  std::uint64_t version_ = 0;
  Worker worker_;  ///< The last member: its jobs use the others.
};

}  // namespace chorus::server
