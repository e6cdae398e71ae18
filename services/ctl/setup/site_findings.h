// What `chorus doctor` finds of the hall that a cell is part of.
#pragma once

#include "services/ctl/setup/findings.h"

namespace chorus::ctl {

/// Whether the cell is connected to the others, knows where it stands, and hears them.  None where
/// there is no site.
[[nodiscard]] Findings site_findings(const ExaminedService& service);

/// The same of an answer of /site/cells/.
[[nodiscard]] Findings site_findings_of(const nlohmann::json& cells);

}  // namespace chorus::ctl
