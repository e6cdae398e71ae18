// What `chorus init` makes sure of before it writes: a service would refuse the configuration
// otherwise, when it is started.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/ctl/setup/written_config.h"

namespace chorus::ctl {

/// A numeric address to listen on, and a token that is long enough (empty: a new one is made).
[[nodiscard]] Result<void> check_service(const std::string& address, const std::string& token);

/// No two sensors of one name.
[[nodiscard]] Result<void> check_names(const std::vector<PolledWish>& sensors);

/// The name by which other hosts reach this one over TLS.  It is `own` if the certificate in this
/// folder contains it or cannot be read.  Otherwise it is the first name in the certificate that
/// other hosts can use, too; if there is none, `own` after all.
[[nodiscard]] std::string certified_name(const std::string& tls_folder, const std::string& own);

/// A line that says how to make the certificate that this folder lacks on this host; empty if there
/// is one, or none is wished for.
[[nodiscard]] std::string certificate_note(const std::string& tls_folder);

/// A value that cannot be meant is a wrong command line, as if the parser had found it: says so and
/// becomes kExitUsage.  All else stays as it is.
[[nodiscard]] Result<int> told_as_usage(std::string_view command, Result<int> done);

}  // namespace chorus::ctl
