// How each command finds the service it talks to: by --url, otherwise by CHORUS_URL, otherwise on
// this host.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace chorus::ctl {

/// Adds --url and what else a request to a server needs.  `names`: the option's names; "url,--url"
/// also accepts it as a positional argument.
void add_server_option(CLI::App& app, std::string& url, const std::string& what,
                       const std::string& names = "--url");

/// Adds to the help that CHORUS_TOKEN holds the token for the server.
void add_token_footer(CLI::App& app);

/// Adds --ca, which names the authorities of https:// servers for every request of this process.
void add_authority_option(CLI::App& app);

}  // namespace chorus::ctl
