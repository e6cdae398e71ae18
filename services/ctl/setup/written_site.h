// For chorus init site: the configuration of a NATS server by which the cells of a hall meet, and
// what each cell needs to join it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::ctl {

inline constexpr const char* kSiteFolder = "/etc/chorus/site";

struct SiteWishes {
  std::string name;                ///< Of the hall.
  std::vector<std::string> cells;  ///< Their names.
  std::string address;             ///< Where the cells reach the server.
  std::uint16_t port = 4222;
  std::string listen = "0.0.0.0";
  std::string tls;  ///< Folder of host.crt, host.key, ca.crt; empty: without TLS.
  std::string store = "/var/lib/chorus/site";  ///< Where the server keeps its buckets.
  std::string folder = kSiteFolder;
};

/// InvalidArgument: no name, no cell, two of one name, or a name that cannot be one.
[[nodiscard]] Result<void> check_site(const SiteWishes& wishes);

/// nats-server's configuration.  `passwords`: of the cells, in their order, and of the user
/// "reader", who may only read.  They are stored as bcrypt hashes.  Nobody comes in without one;
/// each cell may publish under its own name only, and answers to a user come to subjects that
/// nobody else may listen to.  Every cell may write the record of any person.
[[nodiscard]] std::string server_config(const SiteWishes& wishes,
                                        const std::vector<std::string>& passwords);

/// {"site": {...}}, for fusion.json.
[[nodiscard]] std::string cell_config(const SiteWishes& wishes, const std::string& cell,
                                      const std::string& password);

/// Writes nats-server.conf, CELL.json for each cell, and reader.json into the folder; never
/// overwrites them.
[[nodiscard]] Result<void> write_site(const SiteWishes& wishes);

/// NotFound: the authority's certificate that the cell's section names is not on this host.
[[nodiscard]] Result<void> check_authority(const std::string& cell);

/// The configuration `fusion` with the section of `cell`, as text; comments stay.  Conflict: it has
/// a section "site" already.
[[nodiscard]] Result<std::string> joined_config(const std::string& fusion, const std::string& cell);

}  // namespace chorus::ctl
