// The options for offline fusion: the fusion server's configuration file, and overrides.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "fusion-server/pipeline/offline.h"

namespace CLI {
class App;
}

namespace chorus::ctl {

struct OfflineOptions {
  std::string config;  ///< Empty: the documented defaults.
  std::vector<std::string> overrides;
  std::string method;    ///< Empty: as configured.
  std::string joints;    ///< Empty: as configured.
  std::string stature;   ///< [m]; empty: as configured.
  std::string distance;  ///< "cam1,cam2=4.31" [m]; empty: as configured.
};

void add_offline_options(CLI::App& app, OfflineOptions& options);

[[nodiscard]] Result<pipeline::OfflineConfig> offline_config(const OfflineOptions& options);

}  // namespace chorus::ctl
