// chorus calibrate place: where a camera stands.
#pragma once

#include "services/ctl/line/command.h"

namespace chorus::ctl {

/// Declares the options; returns what to run after parsing.
[[nodiscard]] Run add_calibrate_place(CLI::App& options);

}  // namespace chorus::ctl
