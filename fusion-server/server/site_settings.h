// The section "site" of the configuration: how this cell meets the others of its hall.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "fusion-server/nats/cell_link.h"

namespace chorus::server {

struct SiteSettings {
  nats::LinkConfig link;      ///< Without a name there is no site.
  bool outputs_show = false;  ///< The outputs show everybody in the site, not only this cell's.

  bool operator==(const SiteSettings&) const = default;
};

/// The reader's finish() reports mistakes.  `places`: the text of the file that says where the
/// cells stand, which nats::read_places() takes; empty: nothing is known of it.
void read_site(ConfigReader reader, SiteSettings& out, std::string& places);

/// Where our own cell stands according to that text; none: it does not say.
[[nodiscard]] std::optional<site::CellPlace> place_in_file(const SiteSettings& settings,
                                                           const std::string& places);

/// The outputs, and the connection to the other cells if there are any (null: none), which counts
/// as one of them.
[[nodiscard]] std::vector<OutputStatus> with_site(std::vector<OutputStatus> all,
                                                  const nats::CellLink* link);

}  // namespace chorus::server
