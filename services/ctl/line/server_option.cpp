#include "services/ctl/line/server_option.h"

#include <cstdlib>

#include <CLI/CLI.hpp>

namespace chorus::ctl {

void add_server_option(CLI::App& app, std::string& url, const std::string& what,
                       const std::string& names) {
  app.add_option(names, url, what)->envname("CHORUS_URL")->capture_default_str();
  add_authority_option(app);
  add_token_footer(app);
}

void add_token_footer(CLI::App& app) {
  app.footer(app.get_footer() +
             "\nIf the server wants a token: export CHORUS_TOKEN=TOKEN, one of its http.tokens.");
}

void add_authority_option(CLI::App& app) {
  // client::authorities() reads this variable, so every request to a server uses it.
  app.add_option_function<std::string>(
      "--ca", [](const std::string& file) { ::setenv("CHORUS_CA", file.c_str(), 1); },
      "The authority of an https:// server, a PEM file; also CHORUS_CA");
}

}  // namespace chorus::ctl
