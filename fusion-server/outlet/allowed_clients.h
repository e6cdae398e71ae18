// Reads the configuration key "allow" of outputs to which clients connect.
#pragma once

#include "common/base/config_reader.h"
#include "common/net/allow_list.h"

namespace chorus::outlet {

/// Complains if an entry cannot be read.
void read_allow(ConfigReader& reader, net::AllowList& out);

}  // namespace chorus::outlet
