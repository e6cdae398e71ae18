// A registration printed for people: the verdict, the reasons, and where each sensor stands.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace chorus::ctl {

/// Made from the JSON of /registration; absent members show as "-".
[[nodiscard]] std::string registration_report(const nlohmann::json& registration);

}  // namespace chorus::ctl
