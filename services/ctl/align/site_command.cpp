// chorus site register: finds where the cells of a site stand to one another, and writes the file
// that `site.places` of their configurations names.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <future>
#include <iostream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/time/clock.h"
#include "fusion-server/nats/cell_records.h"
#include "fusion-server/site/places.h"
#include "services/ctl/align/site_walk.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/server_option.h"
#include "services/ctl/line/text_file.h"

namespace chorus::ctl {
namespace {

struct SiteArguments {
  std::string action;
  std::vector<std::string> cells;  ///< NAME=SOURCE
  std::vector<std::string> marks;  ///< NAME:X,Z=NAME:X,Z
  std::string origin;
  std::string out = "site-places.json";
  double seconds = 180.0;
};

Result<site::PlacesConfig> places_config(const SiteArguments& arguments) {
  site::PlacesConfig config;
  config.version = static_cast<std::uint64_t>(to_unix_ns(SystemClock().now()) / 1'000'000);
  if (arguments.origin.empty()) return config;
  const auto origin = site::CellId::parse(arguments.origin);
  if (!origin) return pass(origin);
  config.origin = *origin;
  return config;
}

Result<site::SitePlaces> from_marks(const SiteArguments& arguments,
                                    const site::PlacesConfig& config) {
  std::vector<site::CellMark> marks;
  for (const std::string& text : arguments.marks) {
    const auto mark = read_cell_mark(text);
    if (!mark) return pass(mark);
    marks.push_back(*mark);
  }
  return site::places_from_marks(marks, config);
}

Result<site::SitePlaces> from_walk(const SiteArguments& arguments,
                                   const site::PlacesConfig& config) {
  std::vector<NamedCell> cells;
  for (const std::string& text : arguments.cells) {
    auto cell = read_named_cell(text);
    if (!cell) return pass(cell);
    cells.push_back(std::move(*cell));
  }
  if (cells.size() < 2)
    return fail(ErrorCode::InvalidArgument, "register",
                "two cells at least are wanted, each as NAME=SOURCE");
  for (const NamedCell& cell : cells)
    if (const auto ok = answers(cell); !ok) return pass(ok);
  const auto listen = std::chrono::milliseconds(std::llround(arguments.seconds * 1e3));
  const auto live = [](const NamedCell& cell) { return is_live(cell.source); };
  if (std::ranges::any_of(cells, live))
    std::cerr << fmt::format(
        "listening for {:.0f} s: one person walks through all cells, to and fro through each "
        "overlap\n",
        arguments.seconds);
  // Live cells are heard at once: it is one walk.
  std::vector<std::future<Result<site::CellWalk>>> heard;
  for (const NamedCell& cell : cells)
    heard.push_back(std::async(std::launch::async, [&] { return walk_of(cell, listen); }));
  std::vector<site::CellWalk> walks;
  std::optional<Error> failed;
  for (auto& each : heard) {
    auto walk = each.get();
    if (walk)
      walks.push_back(std::move(*walk));
    else if (!failed)
      failed = walk.error();
  }
  if (failed) return tl::unexpected(*failed);
  return site::places_from_walks(walks, config);
}

std::string place_line(const site::SitePlaces& places, std::size_t i) {
  const site::CellPlace& cell = places.cells[i];
  const Eigen::Vector3d t = cell.site_from_cell.translation();
  std::string line = fmt::format(
      "  {:<16} x {:7.3f} m  z {:7.3f} m  yaw {:7.2f} deg  95 % within {:.0f} mm", cell.cell.str(),
      t.x(), t.z(), to_deg(yaw_of(cell.site_from_cell.linear())), to_mm(places.radius[i]));
  if (cell.clock_sigma > Duration{0})
    line += fmt::format("  clock {:+.0f} ms +- {:.0f}", 1e3 * seconds(cell.clock_added),
                        1e3 * seconds(cell.clock_sigma));
  return line + (cell.cell == places.origin ? "  (origin)" : "") + "\n";
}

void print_places(const site::SitePlaces& places) {
  for (std::size_t i = 0; i < places.cells.size(); ++i) std::cout << place_line(places, i);
  for (const site::CellLink& link : places.links) {
    std::cout << fmt::format("  {} - {}: {:.0f} mm between what both saw ({} points)",
                             link.first.str(), link.second.str(), to_mm(link.rms), link.points);
    if (link.loop) std::cout << fmt::format(", worst loop {:.0f} mm", to_mm(*link.loop));
    std::cout << '\n';
  }
  for (const site::CellRefusal& each : places.refused)
    std::cerr << fmt::format("{} has no place: {}\n", each.cell.str(), each.reason);
}

Result<int> run_site(const SiteArguments& arguments) {
  if (arguments.cells.empty() == arguments.marks.empty())
    return fail(ErrorCode::InvalidArgument, "register",
                "wants two cells or more as NAME=SOURCE, or --mark, not both");
  const auto config = places_config(arguments);
  if (!config) return pass(config);
  const auto places =
      arguments.marks.empty() ? from_walk(arguments, *config) : from_marks(arguments, *config);
  if (!places) return pass(places);
  print_places(*places);
  if (auto written = write_text(arguments.out, nats::write_places(places->cells)); !written)
    return pass(written);
  std::cout << "written to " << arguments.out
            << "; name it as `places` in the section `site` of every cell\n";
  return places->refused.empty() ? kExitOk : kExitFailed;
}

}  // namespace

Run add_site(CLI::App& options) {
  auto arguments = std::make_shared<SiteArguments>();
  options.add_option("action", arguments->action, "What to do")
      ->required()
      ->check(CLI::IsMember({"register"}));
  options.add_option("cells", arguments->cells,
                     "NAME=SOURCE of each cell: the address of its fusion server, or a recording "
                     "of what it fused");
  options.add_option("--mark", arguments->marks,
                     "A mark on the floor in two cells: NAME:X,Z=NAME:X,Z [m]; two at least for "
                     "each two cells");
  options.add_option("--origin", arguments->origin,
                     "The cell whose world is the site's space; else the best connected one");
  options.add_option("--seconds", arguments->seconds, "How long live cells are listened to")
      ->check(number_range(1.0, 3600.0))
      ->capture_default_str();
  options.add_option("--out", arguments->out, "The file of places to write")->capture_default_str();
  add_authority_option(options);
  add_token_footer(options);
  return [arguments] { return run_site(*arguments); };
}

}  // namespace chorus::ctl
