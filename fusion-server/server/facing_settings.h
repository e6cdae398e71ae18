// The configuration block "facing" (deploy/config/fusion.json).
#pragma once

#include "common/base/config_reader.h"
#include "fusion-server/facing/sides.h"

namespace chorus::server {

void read_facing(ConfigReader reader, facing::SidesConfig& out);

}  // namespace chorus::server
