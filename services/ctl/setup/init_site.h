// chorus init site: a server by which the cells of a hall meet, or this cell's part in one.
#pragma once

#include <string>

#include "common/base/result.h"
#include "services/ctl/setup/written_site.h"

namespace CLI {
class App;
}

namespace chorus::ctl {

struct InitSite {
  SiteWishes wishes;
  std::string join;  ///< A CELL.json that goes into a fusion.json; empty: a new site.
};

void add_site_options(CLI::App& options, InitSite& arguments);

/// `out`: --out, a folder, or the fusion.json to join; empty: the usual one.
[[nodiscard]] Result<int> run_init_site(InitSite arguments, const std::string& out);

}  // namespace chorus::ctl
