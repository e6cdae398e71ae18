#include "common/service/log_config.h"

#include <string>

namespace chorus::service {
namespace {

template <class T>
void take(ConfigReader& config, std::string_view key, const Result<T>& value, T& out) {
  if (value) {
    out = *value;
  } else {
    config.complain(key, value.error().message);
  }
}

}  // namespace

void read_log(ConfigReader config, LogConfig& out) {
  std::string level = "info";
  std::string format = "text";
  config.read("level", level);
  config.read("format", format);
  take(config, "level", log::parse_level(level), out.level);
  take(config, "format", log::parse_format(format), out.format);
}

void apply(const LogConfig& config) { log::configure(config.level, config.format); }

}  // namespace chorus::service
