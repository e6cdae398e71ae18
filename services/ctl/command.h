// One subcommand of `chorus`: what it is called, what its help teaches, what it does.
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "common/base/result.h"

namespace CLI {
class App;
}

namespace chorus::ctl {

inline constexpr int kExitOk = 0;
inline constexpr int kExitFailed = 1;  ///< The command was valid but failed.
inline constexpr int kExitUsage = 2;   ///< The command line itself is wrong.

/// The exit code, or the error that is printed and becomes kExitFailed.
using Run = std::function<Result<int>()>;

struct Command {
  std::string_view name;
  std::string_view summary;       ///< One line.
  std::string_view examples;      ///< Shown under --help.
  Run (*add)(CLI::App& options);  ///< Declares the options; what it returns runs after parsing.
};

/// In the order of --help.
[[nodiscard]] std::span<const Command> commands();

Run add_import(CLI::App& options);
Run add_register(CLI::App& options);
Run add_status(CLI::App& options);
Run add_record(CLI::App& options);
Run add_replay(CLI::App& options);
Run add_fuse(CLI::App& options);
Run add_export(CLI::App& options);
Run add_camera(CLI::App& options);

/// The whole program: parses, runs, prints errors to standard error.  Never throws.
[[nodiscard]] int run_command_line(int argc, const char* const* argv);

}  // namespace chorus::ctl
