// The events of a fusion server as text.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace chorus::ctl {

/// `told`: the document /events.  A line for each event, oldest first, and a line with what to do.
[[nodiscard]] std::string events_report(const nlohmann::json& told);

}  // namespace chorus::ctl
