// chorus report SOURCE...: how good a recording is, or a running tracker.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/record/cell_outline.h"
#include "common/record/cell_stream.h"
#include "common/record/recording_files.h"
#include "common/report/report_files.h"
#include "services/ctl/convert/fused_frames.h"
#include "services/ctl/evaluate/recorded_quality.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/server_option.h"

namespace chorus::ctl {
namespace {

constexpr double kLongestListening = 3600.0;  // [s]

struct ReportArguments {
  std::vector<std::string> sources;
  std::vector<std::string> out;
  double seconds = 30.0;
};

bool is_recording(const std::string& source) {
  std::error_code too_long;
  return source.ends_with(".mcap") || std::filesystem::is_directory(source, too_long);
}

/// Recordings read side by side, in order of capture: a fused one and those of its sensors.
class SideBySide {
 public:
  explicit SideBySide(const std::vector<record::CellLine>& lines) {
    record::CellQuery query;
    query.fused = true;
    for (const record::CellLine& line : lines)
      lanes_.push_back({record::CellStream(line.files, query), std::nullopt, false});
  }

  /// None at the end.
  Result<std::optional<record::SessionItem>> next() {
    Lane* first = nullptr;
    for (Lane& lane : lanes_) {
      if (!lane.item && !lane.ended) {
        auto item = lane.stream.next();
        if (!item) return pass(item);
        lane.item = std::move(*item);
        lane.ended = !lane.item;
      }
      if (lane.item && (first == nullptr || time_of(*lane.item) < time_of(*first->item)))
        first = &lane;
    }
    if (first == nullptr) return std::nullopt;
    return std::exchange(first->item, std::nullopt);
  }
  [[nodiscard]] record::Notes notes() {
    record::Notes out;
    for (Lane& lane : lanes_)
      for (std::string& note : record::notes_of(lane.stream.finish()))
        out.push_back(std::move(note));
    return out;
  }

 private:
  struct Lane {
    record::CellStream stream;
    std::optional<record::SessionItem> item;
    bool ended = false;
  };

  /// What is no frame holds from then on, and comes at once.
  static Timestamp time_of(const record::SessionItem& item) {
    if (const auto* frame = std::get_if<SensorFrame>(&item)) return frame->captured;
    const auto* fused = std::get_if<resource::FrameResource>(&item);
    return fused == nullptr ? Timestamp::min() : fused->captured;
  }

  std::vector<Lane> lanes_;
};

Result<quality::RecordingQuality> of_recordings(const std::vector<std::string>& sources) {
  std::vector<std::filesystem::path> inputs(sources.begin(), sources.end());
  const auto files = record::find_recordings(inputs);
  if (!files) return pass(files);
  const auto lines = record::cell_lines(*files);
  if (!lines) return pass(lines);
  SideBySide stream(*lines);
  RecordedQuality reading;
  Progress progress(std::cerr, on_terminal(), "reading");
  std::size_t items = 0;
  for (auto item = stream.next(); true; item = stream.next()) {
    if (!item) return pass(item);
    if (!*item) break;
    reading.take(**item);
    if (++items % 20'000 == 0) progress.show(0.0, fmt::format("{} frames", items));
  }
  progress.finish();
  const auto notes = stream.notes();
  if (!reading.any_fused()) {
    for (const std::string& note : notes) std::cerr << "note: " << printable(note) << '\n';
    return fail(ErrorCode::NotFound, sources.front(),
                "holds no fused frames. Fuse it and name both: chorus fuse " + sources.front() +
                    " --out fused.mcap && chorus report fused.mcap " + sources.front());
  }
  quality::RecordingQuality out = reading.finish();
  out.notes = notes;
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
  for (const std::string& file : arguments.out)
    if (auto ok = report::may_write_report(file); !ok) return pass(ok);
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
  for (const std::string& note : quality->notes) std::cerr << "note: " << printable(note) << '\n';
  for (const std::string& remark : quality::remarks_of(*quality))
    std::cerr << "note: " << printable(remark) << '\n';
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
  add_authority_option(options);
  add_token_footer(options);
  return [arguments] { return run_report(*arguments); };
}

}  // namespace chorus::ctl
