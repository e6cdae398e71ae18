#include <array>
#include <exception>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/nearest.h"
#include "common/base/version.h"
#include "services/ctl/command.h"
#include "services/ctl/console.h"

namespace chorus::ctl {
namespace {

constexpr std::array kCommands{
    Command{"import", "Turns other people's recordings into ours, one .mcap per sensor",
            "Examples:\n"
            "  chorus import labanotation Ges01.csv --out rec --floor 0,0.99,0.12,1.1\n"
            "  chorus import pose2sim tests/data/pose2sim_mediapipe --out rec\n"
            "  chorus import nw-ucla a04_s01_e00_v0*.json --out rec --start 2026-11-21T07:30:00Z\n"
            "  chorus import c3d walk.c3d --out rec   (also bvh, mvnx: their world becomes ours)\n"
            "Writes DIR/SENSOR.mcap, and registration.json and truth.ndjson where the source has "
            "them.\n"
            "Then: chorus fuse rec --out fused.ndjson, or chorus replay rec.",
            &add_import},
    Command{"register", "Finds where the sensors stand, from a person who walks through the room",
            "Examples:\n"
            "  chorus register                        walk through the room until it says so\n"
            "  chorus register --seconds 45 --fresh   forget what is known first\n"
            "  chorus register --cancel               end the session that runs\n"
            "  chorus register --json | jq .verdict\n"
            "A session that has started by itself is joined.  The verdict is this walk's own.\n"
            "Exit code 0: good or provisional, and in use; 1: refused (the reasons are printed),\n"
            "cancelled, nobody walked, or no server.",
            &add_register},
    Command{"status", "Shows the sensors, the registration and the fused bodies of a fusion server",
            "Examples:\n"
            "  chorus status\n"
            "  chorus status --url http://127.0.0.1:8080/ --json | jq .sensors\n"
            "Exit code 0: at least one sensor is live; 1: none is, or no server.",
            &add_status},
    Command{"record", "Records a running sensor or fusion server into a file on this machine",
            "Examples:\n"
            "  chorus record --out walk.mcap --seconds 60\n"
            "  chorus record http://10.0.0.5:8080/ --out walk.mcap        until Ctrl-C\n"
            "  chorus record http://10.0.0.5:8081/ --out s1.mcap          one sensor alone\n"
            "Everything a fusion server needs to do its work again: raw frames, clock models,\n"
            "registration; and its fused frames.  Then: chorus fuse walk.mcap --out fused.mcap.",
            &add_record},
    Command{"replay", "Plays recordings as sensors: one chorus-sensor process for each",
            "Examples:\n"
            "  chorus replay rec --loop               all recordings of a folder, ports 8081, "
            "8082, ...\n"
            "  chorus replay rec/cam01.mcap --port 9001\n"
            "  chorus replay walk.mcap --speed 0.5    every sensor of one recording\n"
            "Ctrl-C stops all of them.",
            &add_replay},
    Command{
        "fuse", "Fuses recordings of several sensors offline, registration included",
        "Examples:\n"
        "  chorus fuse rec --out fused.ndjson\n"
        "  chorus fuse walk.mcap --out fused.mcap --config other.json\n"
        "  chorus fuse rec --out fused.ndjson --registration rec/registration.json --method otto\n"
        "  chorus fuse rec --out - --config deploy/config/fusion.json | jq .bodies[0].joints.Head\n"
        "A recording, or one /frame document a line; the same input gives the same bytes.",
        &add_fuse},
    Command{"export", "Writes fused frames as BVH, C3D, TRC, CSV or glTF",
            "Examples:\n"
            "  chorus export cell.mcap --format c3d --out walk.c3d\n"
            "  chorus fuse rec --out - | chorus export - --format bvh --out walk.bvh\n"
            "  chorus export http://127.0.0.1:8080/ --seconds 20 --format gltf --out walk.glb\n"
            "  chorus export fused.ndjson --format csv --person 2 --out - | head\n"
            "What each format holds, and what is lost: docs/guide/export.md.",
            &add_export},
    Command{"camera", "Shows the webcams of this host",
            "Examples:\n"
            "  chorus camera list\n"
            "  chorus camera list --json | jq -r .[0].source\n"
            "Then: chorus-sensor --camera /dev/video0 (docs/guide/cameras.md).",
            &add_camera},
};

struct Added {
  CLI::App* options = nullptr;
  Run run;
};

/// CLI11 would only say that an argument was not expected.
bool complain_of_unknown_command(int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  const std::string word = argv[1];
  std::vector<std::string> known;
  for (const Command& command : kCommands) known.emplace_back(command.name);
  if (std::find(known.begin(), known.end(), word) != known.end()) return false;
  const std::string meant = nearest(word, known);
  std::cerr << fmt::format("chorus: there is no command \"{}\"{}\nThe commands are: {}.\n", word,
                           meant.empty() ? "." : fmt::format("; did you mean \"{}\"?", meant),
                           fmt::join(known, ", "));
  return true;
}

int run_added(const std::vector<Added>& all) {
  for (const Added& each : all) {
    if (!each.options->parsed()) continue;
    const Result<int> code = each.run();
    if (code) return *code;
    std::cerr << fmt::format("chorus {}: {}\n", each.options->get_name(),
                             printable(to_string(code.error())));
    return kExitFailed;
  }
  return kExitUsage;
}

int parse_and_run(int argc, const char* const* argv) {
  CLI::App app{"Chorus: many body-tracking sensors, one tracker."};
  app.name("chorus");
  app.set_version_flag("--version", "chorus " + std::string(version()));
  app.require_subcommand(1);
  app.footer(
      "chorus COMMAND --help explains each with examples.\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage.");
  std::vector<Added> all;
  for (const Command& command : kCommands) {
    auto* options = app.add_subcommand(std::string(command.name), std::string(command.summary));
    options->footer(std::string(command.examples));
    all.push_back({options, command.add(*options)});
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& wrong) {
    return app.exit(wrong) == 0 ? kExitOk : kExitUsage;
  }
  return run_added(all);
}

}  // namespace

std::span<const Command> commands() { return kCommands; }

int run_command_line(int argc, const char* const* argv) {
  if (complain_of_unknown_command(argc, argv)) return kExitUsage;
  try {
    return parse_and_run(argc, argv);
  } catch (const std::exception& unforeseen) {
    std::cerr << "chorus: " << unforeseen.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace chorus::ctl
