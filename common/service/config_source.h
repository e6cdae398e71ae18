// Where a program's configuration comes from: a file, overridden by the command line.
#pragma once

#include <string>
#include <vector>

#include "common/base/config_reader.h"

namespace chorus::service {

struct ConfigSource {
  std::string path;                      ///< Empty: all defaults.
  std::vector<std::string> assignments;  ///< "path=value", in order.
};

/// Reads the file again; the code that reads the keys checks its content.
[[nodiscard]] Result<ConfigReader> read_config(const ConfigSource& source);

}  // namespace chorus::service
