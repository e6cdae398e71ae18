// The configuration key "allow" of outputs that clients connect to.
#pragma once

#include "common/base/config_reader.h"
#include "common/net/allow_list.h"

namespace chorus::outlet {

/// Reports entries that are not addresses.
void read_allow(ConfigReader& reader, net::AllowList& out);

}  // namespace chorus::outlet
