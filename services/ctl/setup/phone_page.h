// What chorus init sensor says of the page that makes a phone's camera a sensor.
#pragma once

#include <string>

#include "services/ctl/setup/written_config.h"

namespace chorus::ctl {

[[nodiscard]] bool is_loopback(const std::string& address);

/// Prints the page to open.  A browser allows camera access over https, and on its own host over
/// http as well.
void tell_phone(const ServiceWishes& wishes, const std::string& url);

}  // namespace chorus::ctl
