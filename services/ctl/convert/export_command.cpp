// chorus export SOURCE --format FORMAT --out FILE: writes fused frames as files for other programs.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/duration.h"
#include "common/exporters/export_formats.h"
#include "services/ctl/convert/fused_file.h"
#include "services/ctl/convert/fused_frames.h"
#include "services/ctl/convert/fused_samples.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/server_option.h"
#include "services/ctl/line/text_file.h"

namespace chorus::ctl {
namespace {

/// Unlike the motion formats, this one holds the frames as they are, on no grid.
constexpr std::string_view kFrames = "ndjson";
constexpr std::string_view kFramesAre =
    "the frames as they are, a line each: covariances, contributors, ages";

struct ExportArguments {
  std::string source;
  std::string format;
  std::string out;
  std::optional<std::uint64_t> person;
  double rate_hz = 0.0;
  int max_gap_ms = 200;
  bool on_grid = false;  ///< True if --rate or --max-gap was given.
  double seconds = 10.0;
  std::string unit = "cm";
  bool wide = false;
  std::string columns = "chorus";
  bool json = false;
};

/// "walk.bvh" and "-p2" -> "walk-p2.bvh"; standard output ("-") remains standard output.
std::string with_suffix(const std::string& file, const std::string& suffix) {
  if (suffix.empty() || file == "-") return file;
  const std::filesystem::path path(file);
  return (path.parent_path() / (path.stem().string() + suffix + path.extension().string()))
      .string();
}

exporters::ExportFormat format_of(const std::string& name) {
  const auto* row = std::find_if(exporters::kExportFormats.begin(), exporters::kExportFormats.end(),
                                 [&](const auto& each) { return each.name == name; });
  return row->format;  // the name was checked while parsing
}

Result<std::vector<std::string>> write_files(const exporters::Exported& exported,
                                             const ExportArguments& arguments) {
  const std::string& out = arguments.out;
  if (out == "-" && exported.files.size() > 1)
    return fail(ErrorCode::InvalidArgument, "standard output",
                "can take one file; this format holds one person. Name one with --person.");
  std::vector<std::string> written;
  for (const exporters::ExportedFile& file : exported.files) {
    written.push_back(with_suffix(out, file.suffix));
    if (auto ok = may_write(written.back(), {arguments.source}); !ok) return pass(ok);
    const auto done = write_text(written.back(), file.bytes);
    if (!done) return pass(done);
  }
  return written;
}

struct Done {
  const exporters::Take& take;
  const exporters::Exported& exported;
  const std::vector<std::string>& notes;  ///< Notes of the source.
  const std::vector<std::string>& written;
};

void report(const Done& done, bool as_json) {
  const auto& [take, exported, notes, written] = done;
  if (as_json) {
    nlohmann::json persons = nlohmann::json::array();
    for (const auto& track : take.persons) persons.push_back(track.person.value);
    std::cerr << nlohmann::json{{"files", written},       {"frames", take.frames},
                                {"rateHz", take.rate_hz}, {"start", to_iso8601(take.start)},
                                {"persons", persons},     {"remarks", exported.remarks},
                                {"notes", notes}}
                     .dump(2)
              << '\n';
    return;
  }
  for (const std::string& note : notes) std::cerr << "note: " << note << '\n';
  std::cerr << fmt::format("{} {}, {} frames at {:.6g} Hz from {}\n", take.persons.size(),
                           take.persons.size() == 1 ? "person" : "persons", take.frames,
                           take.rate_hz, to_iso8601(take.start));
  for (const std::string& remark : exported.remarks) std::cerr << remark << '\n';
  for (const std::string& file : written) std::cerr << "wrote " << file << '\n';
  if (!written.empty() && written.front().ends_with(".gltf"))
    std::cerr << "note: this is binary glTF; most programs want it to be called .glb\n";
}

std::chrono::milliseconds listening(const ExportArguments& arguments) {
  return std::chrono::milliseconds(std::llround(arguments.seconds * 1e3));
}

/// What was written as lines.
struct Lines {
  std::size_t frames = 0;
  std::size_t with_bodies = 0;
  record::Notes notes;
};

Result<Lines> write_lines(const ExportArguments& arguments) {
  auto file = FrameLines::create(arguments.out);
  if (!file) return pass(file);
  Lines lines;
  const auto take = [&](const resource::FrameResource& frame, const std::string&) {
    resource::FrameResource kept = frame;
    if (arguments.person)
      std::erase_if(kept.bodies, [&](const auto& body) { return body.id != *arguments.person; });
    ++lines.frames;
    if (!kept.bodies.empty()) ++lines.with_bodies;
    return file->add(kept);
  };
  auto notes = each_fused_frame(arguments.source, listening(arguments), take);
  if (!notes) return pass(notes);
  lines.notes = std::move(*notes);
  if (lines.with_bodies == 0)
    return fail(ErrorCode::NotFound, arguments.source,
                arguments.person ? "has no frame with this person." : "has nobody in any frame.");
  if (auto ok = file->finish(); !ok) return pass(ok);
  return lines;
}

Result<int> run_lines(const ExportArguments& arguments) {
  if (arguments.on_grid)
    return fail(ErrorCode::InvalidArgument, "--format ndjson",
                "writes the frames as they are; leave --rate and --max-gap out");
  const auto lines = write_lines(arguments);
  if (!lines) return pass(lines);
  if (arguments.json) {
    std::cerr << nlohmann::json{{"files", {arguments.out}},
                                {"frames", lines->frames},
                                {"framesWithBodies", lines->with_bodies},
                                {"notes", lines->notes}}
                     .dump(2)
              << '\n';
    return kExitOk;
  }
  for (const std::string& note : lines->notes) std::cerr << "note: " << note << '\n';
  std::cerr << fmt::format("{} frames, {} with somebody in them\nwrote {}\n", lines->frames,
                           lines->with_bodies, arguments.out);
  return kExitOk;
}

Result<void> check_columns(const ExportArguments& arguments) {
  if (arguments.wide && arguments.format != "csv")
    return fail(ErrorCode::InvalidArgument, "--wide", "is for --format csv");
  const bool named = arguments.columns != exporters::kColumnNames.front();
  if (named && !arguments.wide && arguments.format != "trc")
    return fail(ErrorCode::InvalidArgument, "--columns",
                "is for --format trc, and csv with --wide");
  if (arguments.columns == "motive" && arguments.format == "trc")
    return fail(ErrorCode::InvalidArgument, "--columns motive",
                "names bones, which TRC does not have; use --format csv --wide");
  return {};
}

exporters::ColumnNames columns_of(const ExportArguments& arguments) {
  const auto& names = exporters::kColumnNames;
  const auto found = std::ranges::find(names, arguments.columns);
  return static_cast<exporters::ColumnNames>(found - names.begin());
}

Result<int> run_export(const ExportArguments& arguments) {
  if (auto ok = check_columns(arguments); !ok) return pass(ok);
  if (auto ok = may_write(arguments.out, {arguments.source}); !ok) return pass(ok);
  if (arguments.format == kFrames) return run_lines(arguments);
  auto source = read_fused_frames(arguments.source, listening(arguments));
  if (!source) return pass(source);
  exporters::TakeOptions options;
  options.rate_hz = arguments.rate_hz;
  options.max_gap = std::chrono::milliseconds(arguments.max_gap_ms);
  if (arguments.person) options.person = PersonId{*arguments.person};
  const auto take = exporters::make_take(std::move(source->samples), options);
  if (!take) return pass(take);
  exporters::ExportOptions how;
  how.file_name = std::filesystem::path(arguments.out).filename().string();
  how.units_per_metre = arguments.unit == "m" ? 1.0 : 100.0;
  how.wide = arguments.wide;
  how.columns = columns_of(arguments);
  const auto exported = exporters::exported(*take, format_of(arguments.format), how);
  if (!exported) return pass(exported);
  const auto written = write_files(*exported, arguments);
  if (!written) return pass(written);
  report({*take, *exported, source->notes, *written}, arguments.json);
  return kExitOk;
}

void add_format_option(CLI::App& options, ExportArguments& arguments) {
  std::string formats = "One of:";
  std::vector<std::string> names;
  for (const auto& row : exporters::kExportFormats) {
    formats += fmt::format("\n{}: {}", row.name, row.writes);
    names.emplace_back(row.name);
  }
  formats += fmt::format("\n{}: {}", kFrames, kFramesAre);
  names.emplace_back(kFrames);
  options.add_option("--format", arguments.format, formats)
      ->required()
      ->check(CLI::IsMember(names));
}

}  // namespace

Run add_export(CLI::App& options) {
  const auto arguments = std::make_shared<ExportArguments>();
  options
      .add_option("source", arguments->source,
                  "Recording (.mcap or a folder of them), NDJSON of chorus fuse, - for NDJSON on "
                  "standard input, or http://HOST:PORT/ of a fusion server")
      ->required();
  add_format_option(options, *arguments);
  options.add_option("--out", arguments->out, "File to write; - is standard output")->required();
  options.add_option("--person", arguments->person, "Only the person of this id");
  const auto* rate =
      options
          .add_option("--rate", arguments->rate_hz, "Frames a second [Hz]; the source's by default")
          ->check(number_range(0.1, 1000.0));
  const auto* gap =
      options
          .add_option("--max-gap", arguments->max_gap_ms,
                      "Longest hole that is bridged [ms]; joints are missing in longer ones")
          ->check(CLI::Range(0, 60'000))
          ->capture_default_str();
  options.add_option("--seconds", arguments->seconds, "How long to listen to a server [s]")
      ->check(number_range(0.1, 86'400.0))
      ->capture_default_str();
  options.add_option("--unit", arguments->unit, "Of lengths in BVH")
      ->check(CLI::IsMember({"cm", "m"}))
      ->capture_default_str();
  options.add_flag("--wide", arguments->wide, "CSV with one row a frame");
  options.add_option("--columns", arguments->columns, "Names of the columns of wide CSV and TRC")
      ->check(CLI::IsMember({"chorus", "motive", "pose2sim"}))
      ->capture_default_str();
  add_authority_option(options);
  add_token_footer(options);
  options.add_flag("--json", arguments->json, "Summary as JSON");
  return [arguments, rate, gap] {
    arguments->on_grid = rate->count() > 0 || gap->count() > 0;
    return run_export(*arguments);
  };
}

}  // namespace chorus::ctl
