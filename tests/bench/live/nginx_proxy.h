// A real nginx in front of one of our services.
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/base/result.h"
#include "tests/bench/live/child_process.h"

namespace chorus::bench {

inline constexpr const char* kNginx = "/usr/sbin/nginx";

struct ProxyPlan {
  std::filesystem::path folder;  ///< For its configuration and temporary files.
  std::uint16_t port = 0;        ///< Where it listens on loopback.
  std::uint16_t upstream = 0;    ///< The port of our service.
  int connections = 64;          ///< Of its one worker: two for each client.
  /// Further lines of `location /`, each with its semicolon.
  const char* lines = "";
};

/// Starts nginx as the simplest guides configure it: proxy_pass, and nothing more but `lines`.
[[nodiscard]] Result<ChildProcess> start_proxy(const ProxyPlan& plan);

}  // namespace chorus::bench
