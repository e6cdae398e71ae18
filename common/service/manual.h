// Makes the manual page and the shell completion of a program from the options that --help shows.
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

/// `section`: 1 for users' commands, 8 for services.  `files`: the lines "NAME meaning" of the
/// section FILES; if empty, that section is left out.
struct Manual {
  int section = 1;
  std::string_view files = {};
};

[[nodiscard]] std::string manual_page(const CLI::App& app, const Manual& manual);

/// Completes commands and their options; every other word is completed as a file name.
[[nodiscard]] std::string bash_completion(const CLI::App& app);

/// What the program prints for `--print manual` or `--print completion`; none when neither was
/// given.
[[nodiscard]] std::optional<std::string> printed(const CLI::App& app, const Manual& manual,
                                                 int argc, const char* const* argv);

}  // namespace chorus::service
