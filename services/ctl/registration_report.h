// A registration printed for people: the verdict, the reasons, where each sensor stands.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace chorus::ctl {

/// From the JSON of /registration; members that are absent show as "-".
[[nodiscard]] std::string registration_report(const nlohmann::json& registration);

}  // namespace chorus::ctl
