// The configuration section "log", the same for every service.
#pragma once

#include "common/base/config_reader.h"
#include "common/base/log.h"

namespace chorus::service {

struct LogConfig {
  log::Level level = log::Level::Info;
  log::Format format = log::Format::Text;

  bool operator==(const LogConfig&) const = default;
};

/// Reads the section; the reader's finish() reports mistakes.
void read_log(ConfigReader config, LogConfig& out);

/// Applies the config to the log from now on.
void apply(const LogConfig& config);

}  // namespace chorus::service
