// The manual page and the completion of a program, made from the options that --help shows.
//
//   PROGRAM --print manual       roff, for man
//   PROGRAM --print completion   for bash
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace chorus::service {

/// `section`: 1 for commands of users, 8 for services.  `files`: lines for the section FILES, each
/// "NAME meaning"; empty: no such section.
struct Manual {
  int section = 1;
  std::string_view files = {};
};

[[nodiscard]] std::string manual_page(const CLI::App& app, const Manual& manual);

/// Commands, and the options of each; what is no option is completed as a file.
[[nodiscard]] std::string bash_completion(const CLI::App& app);

/// What `--print manual` or `--print completion` asks for; nothing when neither was given.
[[nodiscard]] std::optional<std::string> printed(const CLI::App& app, const Manual& manual,
                                                 int argc, const char* const* argv);

}  // namespace chorus::service
