// Where a program's configuration comes from: a file, then assignments from the command line that
// override it.
#pragma once

#include <string>
#include <vector>

#include "common/base/config_reader.h"

namespace chorus::service {

struct ConfigSource {
  std::string path;                      ///< Empty: every key has its default.
  std::vector<std::string> assignments;  ///< "path=value", in order.
};

/// Reads the file, each time it is called.  The code that reads the keys checks them.
[[nodiscard]] Result<ConfigReader> read_config(const ConfigSource& source);

}  // namespace chorus::service
