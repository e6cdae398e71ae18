// Runs `chorus` to its end and says what it cost.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::bench {

struct RunCost {
  double seconds = 0.0;
  double rss_mb = 0.0;  ///< Largest resident set.
  int exit_code = 0;
};

/// Runs `chorus` from this program's folder and waits for it.  An error when it could not be run,
/// was killed, or its exit code is larger than `largest_code`.
[[nodiscard]] Result<RunCost> run_chorus(const std::vector<std::string>& arguments,
                                         int largest_code = 0);

}  // namespace chorus::bench
