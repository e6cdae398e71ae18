// One subcommand of `chorus`: its name, its help, and what it does.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace CLI {
class App;
}

namespace chorus::ctl {

inline constexpr int kExitOk = 0;
inline constexpr int kExitFailed = 1;         ///< The command was valid but failed.
inline constexpr int kExitUsage = 2;          ///< The command line itself is wrong.
inline constexpr int kExitInterrupted = 130;  ///< Ctrl-C, as shells count it.

/// Returns the exit code, or an error, which is printed and becomes kExitFailed.
using Run = std::function<Result<int>()>;

struct Command {
  std::string_view name;
  std::string_view summary;       ///< One line.
  std::string_view examples;      ///< Shown under --help.
  Run (*add)(CLI::App& options);  ///< Declares the options; returns what to run after parsing.
};

/// In the order of --help.  Two lists, so that a program can do without the libraries that the
/// second one needs.
[[nodiscard]] std::span<const Command> host_commands();
[[nodiscard]] std::span<const Command> recording_commands();
inline constexpr std::array<std::string_view, 17> kRecordingCommandNames{
    "import",    "replay",       "view",     "fuse",     "export", "train-error",
    "calibrate", "characterise", "align",    "scan",     "glove",  "report",
    "compare",   "score",        "evaluate", "position", "site"};
[[nodiscard]] std::vector<Command> all_commands();

Run add_init(CLI::App& options);
Run add_doctor(CLI::App& options);
Run add_import(CLI::App& options);
Run add_register(CLI::App& options);
Run add_origin(CLI::App& options);
Run add_status(CLI::App& options);
Run add_record(CLI::App& options);
Run add_mark(CLI::App& options);
Run add_replay(CLI::App& options);
Run add_view(CLI::App& options);
Run add_fuse(CLI::App& options);
Run add_export(CLI::App& options);
Run add_train_error(CLI::App& options);
Run add_camera(CLI::App& options);
Run add_calibrate(CLI::App& options);
Run add_characterise(CLI::App& options);
Run add_align(CLI::App& options);
Run add_evaluate(CLI::App& options);
Run add_scan(CLI::App& options);
Run add_glove(CLI::App& options);
Run add_report(CLI::App& options);
Run add_site(CLI::App& options);
Run add_compare(CLI::App& options);
Run add_score(CLI::App& options);
Run add_position(CLI::App& options);
Run add_discover(CLI::App& options);

/// The whole program: parses, runs, prints errors to standard error.  Never throws.
[[nodiscard]] int run_command_line(std::span<const Command> commands, int argc,
                                   const char* const* argv);

}  // namespace chorus::ctl
