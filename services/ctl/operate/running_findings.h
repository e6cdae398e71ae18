// What `chorus doctor` asks the programs themselves: the service's own --check, and what the
// running service says of its configuration and of its sensors.
#pragma once

#include "services/ctl/setup/findings.h"

namespace chorus::ctl {

/// Runs `chorus-KIND --check --config FILE`; none where the program is not installed.
[[nodiscard]] Findings check_findings(const ExaminedService& service);
/// Whether the running service runs with what is in the file; none if it does not say.
[[nodiscard]] Findings configuration_findings(const ExaminedService& service);
/// The sensors of a fusion server as it sees them itself (/sensors/): one for each that delivers
/// nothing.  None if it does not answer.
[[nodiscard]] Findings followed_findings(const ExaminedService& service);

}  // namespace chorus::ctl
