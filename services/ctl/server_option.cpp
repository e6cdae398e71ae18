#include "services/ctl/server_option.h"

#include <CLI/CLI.hpp>

namespace chorus::ctl {

void add_server_option(CLI::App& app, std::string& url, const std::string& what,
                       const std::string& names) {
  app.add_option(names, url, what)->envname("CHORUS_URL")->capture_default_str();
}

}  // namespace chorus::ctl
