// chorus report SOURCE...: how good a recording is, or a running tracker.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/quality/quality_report.h"
#include "common/record/cell_stream.h"
#include "common/record/recording_files.h"
#include "common/report/report_files.h"
#include "fusion-server/wire/registration_file.h"
#include "fusion-server/wire/registration_nodes.h"
#include "services/ctl/convert/fused_frames.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"

namespace chorus::ctl {
namespace {

constexpr double kLongestListening = 3600.0;  // [s]

struct ReportArguments {
  std::vector<std::string> sources;
  std::vector<std::string> out;
  double seconds = 30.0;
};

bool is_recording(const std::string& source) {
  return std::filesystem::is_directory(source) || source.ends_with(".mcap");
}

std::map<SensorId, Eigen::Isometry3d> places_of(const Registration& registration) {
  std::map<SensorId, Eigen::Isometry3d> places;
  for (const auto& [id, sensor] : registration.sensors) places[id] = sensor.world_from_sensor;
  return places;
}

struct Reading {
  quality::FusedJudge fused;
  quality::SensorJudge sensors;
  std::string verdict;
  bool any_fused = false;

  void take(const record::SessionItem& item) {
    if (const auto* frame = std::get_if<SensorFrame>(&item)) return sensors.add(*frame);
    if (const auto* frame = std::get_if<resource::FrameResource>(&item)) {
      any_fused = true;
      fused.add(*frame);
      return sensors.add(*frame);
    }
    const auto registration = wire::read_registration(std::get<std::string>(item));
    if (!registration) return;  // a recording without places still has fused frames to judge
    verdict = wire::name_of(registration->verdict);
    sensors.place(places_of(*registration));
  }
};

Result<quality::RecordingQuality> of_recordings(const std::vector<std::string>& sources) {
  std::vector<std::filesystem::path> inputs(sources.begin(), sources.end());
  const auto files = record::find_recordings(inputs);
  if (!files) return pass(files);
  record::CellQuery query;
  query.fused = true;
  record::CellStream stream(*files, query);
  Reading reading;
  Progress progress(std::cerr, on_terminal(), "reading");
  std::size_t items = 0;
  for (auto item = stream.next(); true; item = stream.next()) {
    if (!item) return pass(item);
    if (!*item) break;
    reading.take(**item);
    if (++items % 20'000 == 0) progress.show(0.0, fmt::format("{} frames", items));
  }
  progress.finish();
  if (!reading.any_fused)
    return fail(ErrorCode::NotFound, sources.front(),
                "holds no fused frames. Fuse it and name both: chorus fuse " + sources.front() +
                    " --out fused.mcap && chorus report fused.mcap " + sources.front());
  quality::RecordingQuality out;
  out.fused = reading.fused.finish();
  out.sensors = reading.sensors.finish();
  out.verdict = reading.verdict;
  out.notes = record::notes_of(stream.finish());
  return out;
}

Result<quality::RecordingQuality> of_frames(const ReportArguments& arguments) {
  quality::FusedJudge judge;
  const auto take = [&](const resource::FrameResource& frame, const std::string&) -> Result<void> {
    judge.add(frame);
    return {};
  };
  auto notes =
      each_fused_frame(arguments.sources.front(),
                       std::chrono::milliseconds(static_cast<int>(1e3 * arguments.seconds)), take);
  if (!notes) return pass(notes);
  quality::RecordingQuality out;
  out.fused = judge.finish();
  out.notes = std::move(*notes);
  return out;
}

Result<int> run_report(const ReportArguments& arguments) {
  const bool recordings =
      std::all_of(arguments.sources.begin(), arguments.sources.end(), is_recording);
  if (!recordings && arguments.sources.size() > 1)
    return fail(ErrorCode::InvalidArgument, arguments.sources[1],
                "several sources are read together only if all are recordings");
  auto quality = recordings ? of_recordings(arguments.sources) : of_frames(arguments);
  if (!quality) return pass(quality);
  quality->name = arguments.sources.front();
  const report::Report report = quality::report_of(*quality);
  for (const std::string& file : arguments.out) {
    const auto written = report::write_report(report, file);
    if (!written) return pass(written);
    std::cerr << "wrote " << file << '\n';
  }
  std::cout << printable(report.verdict) << '\n';
  for (const quality::Finding& finding : quality::findings_of(*quality))
    std::cout << printable(fmt::format("- {}: {}", finding.what, finding.advice)) << '\n';
  return report.judgement == report::Judgement::Bad ? kExitFailed : kExitOk;
}

}  // namespace

Run add_report(CLI::App& options) {
  auto arguments = std::make_shared<ReportArguments>();
  options
      .add_option("source", arguments->sources,
                  "recordings (files or folders), a file of NDJSON, or a fusion server's address")
      ->required();
  options.add_option("--out", arguments->out,
                     "write the report: .html, .json or .csv; repeat for several");
  options.add_option("--seconds", arguments->seconds, "how long to listen to a server")
      ->check(number_range(1.0, kLongestListening));
  return [arguments] { return run_report(*arguments); };
}

}  // namespace chorus::ctl
