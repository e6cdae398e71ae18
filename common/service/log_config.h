// The section "log" of every service's configuration.
#pragma once

#include "common/base/config_reader.h"
#include "common/base/log.h"

namespace chorus::service {

struct LogConfig {
  log::Level level = log::Level::Info;
  log::Format format = log::Format::Text;

  bool operator==(const LogConfig&) const = default;
};

/// The reader's finish() reports mistakes.
void read_log(ConfigReader config, LogConfig& out);

/// Applies the config to the log from now on.
void apply(const LogConfig& config);

}  // namespace chorus::service
