// The section "site" of the configuration: how this cell meets the others of its hall.
#pragma once

#include "common/base/config_reader.h"
#include "fusion-server/nats/cell_link.h"

namespace chorus::server {

struct SiteSettings {
  nats::LinkConfig link;      ///< Without a name there is no site.
  std::string places_file;    ///< Where the cells stand; empty: nothing is known of it.
  bool outputs_show = false;  ///< The outputs show everybody in the site, not only this cell's.

  bool operator==(const SiteSettings&) const = default;
};

/// The reader's finish() reports mistakes.
void read_site(ConfigReader reader, SiteSettings& out);

}  // namespace chorus::server
