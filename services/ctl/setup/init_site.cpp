#include "services/ctl/setup/init_site.h"

#include <iostream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/file.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/new_file.h"

namespace chorus::ctl {
namespace {

constexpr const char* kFusionFile = "/etc/chorus/fusion.json";
constexpr std::size_t kMostBytes = 1 << 20;

/// Adds a cell's section to the configuration of its fusion server.
Result<int> run_join(const std::string& file, const std::string& cell_file) {
  const auto fusion = read_file(file, kMostBytes);
  if (!fusion) return pass(fusion);
  const auto cell = read_file(cell_file, kMostBytes);
  if (!cell) return pass(cell);
  if (auto ok = check_authority(*cell); !ok) return pass(ok);
  const auto joined = joined_config(*fusion, *cell);
  if (!joined) return pass(joined);
  if (auto ok = write_file(file, *joined, Readers::Services, Overwriting::Yes); !ok)
    return pass(ok);
  std::cerr << file << " has the section \"site\" now.  Next:\n  systemctl restart chorus-fusion\n";
  return kExitOk;
}

void tell_what_next(const SiteWishes& wishes) {
  std::cerr << fmt::format(
      "{0}/nats-server.conf written, and for each cell a file with its password.  Next:\n"
      "  systemctl enable --now chorus-site     (nats-server -c {0}/nats-server.conf)\n"
      "On each cell, with its file from here:\n"
      "  chorus init site --join {1}.json\n  systemctl restart chorus-fusion\n",
      wishes.folder, wishes.cells.front());
  if (wishes.tls.empty())
    std::cerr << "Without a certificate passwords can be read on the way: chorus init ca and "
                 "chorus init certificate, then this again into an empty folder.\n";
}

}  // namespace

void add_site_options(CLI::App& options, InitSite& arguments) {
  options.add_option("--cell", arguments.wishes.cells, "site: name of a cell; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  options.add_option("--address", arguments.wishes.address,
                     "site: where the cells reach the server; default: this host's name");
  options.add_option("--store", arguments.wishes.store, "site: folder for what the server keeps")
      ->capture_default_str();
  options.add_option("--join", arguments.join,
                     "site: adds this CELL.json to /etc/chorus/fusion.json, or to --out");
}

Result<int> run_init_site(InitSite arguments, const std::string& out) {
  if (!arguments.join.empty()) return run_join(out.empty() ? kFusionFile : out, arguments.join);
  if (!out.empty()) arguments.wishes.folder = out;
  if (auto ok = write_site(arguments.wishes); !ok) return pass(ok);
  tell_what_next(arguments.wishes);
  return kExitOk;
}

}  // namespace chorus::ctl
