// Reads the configuration key "allow" of outputs to which clients connect.
#pragma once

#include "common/base/config_reader.h"
#include "common/net/allow_list.h"

namespace chorus::outlet {

/// Complains about entries that are not addresses.
void read_allow(ConfigReader& reader, net::AllowList& out);

}  // namespace chorus::outlet
