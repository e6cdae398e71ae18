// chorus evaluate --tracking REC --inertial FILE...: judges a tracker with inertial sensors.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/duration.h"
#include "common/base/file.h"
#include "common/base/median.h"
#include "common/base/units.h"
#include "common/evaluation/judge.h"
#include "common/evaluation/limb_frame.h"
#include "common/evaluation/pronation.h"
#include "common/report/report_files.h"
#include "services/ctl/convert/fused_samples.h"
#include "services/ctl/evaluate/evaluation_report.h"
#include "services/ctl/evaluate/inertial_files.h"
#include "services/ctl/evaluate/reference_take.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/server_option.h"

namespace chorus::ctl {
namespace {

constexpr std::uintmax_t kMostAnnotationBytes = 16u << 20;

struct EvaluateArguments {
  std::string tracking, calibration, reference, reference_joints, reference_unit,
      out = "evaluation";
  std::vector<std::string> inertial, calibration_inertial, annotations, limbs;
  std::optional<std::uint64_t> person;
  double tau_deg = to_deg(evaluation::kPaperTau);
  double most_percent = 5.0;
  double seconds = 30.0;
  bool stated = false;  ///< Orientations that the tracker states, instead of those of its joints.
  bool same_clock = false;
  bool from_start = false;
  bool json = false;
};

using Samples = std::vector<exporters::FusedSample>;

/// The limbs of each person over seconds after the first frame.
std::map<std::uint64_t, evaluation::TrackedBody> people_of(const Samples& samples, bool stated) {
  std::map<std::uint64_t, evaluation::TrackedBody> out;
  for (const auto& sample : samples) {
    const double time = seconds(sample.instant - samples.front().instant);
    for (std::size_t i = 0; i < inertial::kLimbCount; ++i) {
      const auto limb = static_cast<inertial::Limb>(i);
      const auto seen = stated ? evaluation::limb_under_sensor(sample.skeleton, limb)
                               : evaluation::limb_from_joints(sample.skeleton, limb);
      if (seen) out[sample.person.value][limb].push_back({time, *seen});
    }
  }
  return out;
}

/// What the sensors' times count from: the tracker's first frame where both have been recorded by
/// one clock, so that they overlap; otherwise their own first reading.
Timestamp origin_of(const std::vector<inertial::SensorLog>& logs, const Samples& samples) {
  Timestamp first = logs.front().readings.front().captured;
  Timestamp last = first;
  for (const inertial::SensorLog& log : logs) {
    first = std::min(first, log.readings.front().captured);
    last = std::max(last, log.readings.back().captured);
  }
  const bool overlap = first <= samples.back().instant && samples.front().instant <= last;
  return overlap ? samples.front().instant : first;
}

std::vector<evaluation::JudgeSensor> sensors_of(const std::vector<inertial::SensorLog>& logs,
                                                Timestamp origin) {
  std::vector<evaluation::JudgeSensor> out;
  for (const inertial::SensorLog& log : logs) {
    evaluation::JudgeSensor sensor{log.sensor, log.readings.front().limb, {}};
    for (const auto& reading : log.readings)
      if (reading.inertial_from_sensor)
        sensor.track.push_back({seconds(reading.captured - origin), *reading.inertial_from_sensor});
    out.push_back(std::move(sensor));
  }
  return out;
}

/// True if all were recorded into one file: by one clock.
bool in_one_file(const std::string& tracking, const std::vector<std::string>& inertial) {
  return std::ranges::all_of(inertial, [&](const std::string& file) {
    std::error_code none;
    return std::filesystem::equivalent(tracking, file, none);
  });
}

evaluation::JudgeOptions options_of(const EvaluateArguments& arguments) {
  evaluation::JudgeOptions options;
  options.tau = deg(arguments.tau_deg);
  options.carry_back = arguments.from_start;
  if (arguments.same_clock || in_one_file(arguments.tracking, arguments.inertial))
    options.time.largest = 0.0;
  return options;
}

/// The error of a judgement with the option that may help.
Error with_clock_advice(Error error, const EvaluateArguments& arguments) {
  if (error.context == "time" && options_of(arguments).time.largest > 0.0)
    error.message += " If one clock recorded both, say --same-clock";
  return error;
}

struct Loaded {
  evaluation::TrackedBody body;
  std::vector<evaluation::JudgeSensor> sensors;
  comparison::Track joints;  ///< Of the same person, over the same time.
};

using People = std::map<std::uint64_t, evaluation::TrackedBody>;

/// The person named, the only one, or the one whom the sensors fit.
Result<std::uint64_t> wearer_of(const People& people,
                                const std::vector<evaluation::JudgeSensor>& sensors,
                                const EvaluateArguments& arguments) {
  if (arguments.person) {
    if (people.contains(*arguments.person)) return *arguments.person;
    return fail(ErrorCode::NotFound, "--person", "is not in the recording");
  }
  if (people.size() == 1) return people.begin()->first;
  std::vector<std::uint64_t> ids;
  std::vector<evaluation::TrackedBody> bodies;
  for (const auto& [id, body] : people) {
    ids.push_back(id);
    bodies.push_back(body);
  }
  const auto wearer = evaluation::wearer_among(bodies, sensors, options_of(arguments));
  if (!wearer)
    return fail(ErrorCode::InvalidArgument, arguments.tracking,
                fmt::format("shows {} people, and who wears the sensors is not clear ({}); say it "
                            "with --person",
                            ids.size(), wearer.error().message));
  std::cerr << fmt::format("note: of {} people, person {} wears the sensors\n", ids.size(),
                           ids[*wearer]);
  return ids[*wearer];
}

/// The joints of one person over seconds after the first frame, in order of time.
comparison::Track joints_of(const Samples& samples, std::uint64_t person) {
  comparison::Track out;
  for (const auto& sample : samples)
    if (sample.person.value == person)
      out.push_back({seconds(sample.instant - samples.front().instant), sample.skeleton});
  std::ranges::stable_sort(out, {}, &comparison::Moment::time);
  return out;
}

Result<Loaded> load(const std::string& tracking, const std::vector<std::string>& files,
                    const EvaluateArguments& arguments) {
  const auto listen = std::chrono::milliseconds(std::llround(arguments.seconds * 1e3));
  const auto frames = read_fused_frames(tracking, listen);
  if (!frames) return pass(frames);
  for (const std::string& note : frames->notes) std::cerr << "note: " << note << '\n';
  if (frames->samples.empty()) return fail(ErrorCode::NotFound, tracking, "shows nobody");
  const auto logs = read_inertial_files(files, arguments.limbs);
  if (!logs) return pass(logs);
  for (const auto& log : *logs)
    for (const std::string& note : log.notes)
      std::cerr << "note: sensor " << log.sensor << ": " << note << '\n';
  for (const std::string& note : inertial::heading_notes(*logs))
    std::cerr << "note: " << note << '\n';
  auto sensors = sensors_of(*logs, origin_of(*logs, frames->samples));
  People people = people_of(frames->samples, arguments.stated);
  const auto wearer = wearer_of(people, sensors, arguments);
  if (!wearer) return pass(wearer);
  return Loaded{std::move(people[*wearer]), std::move(sensors),
                joints_of(frames->samples, *wearer)};
}

Result<EvaluationInputs> inputs_of(const EvaluateArguments& arguments) {
  EvaluationInputs out{arguments.tracking,
                       arguments.inertial,
                       deg(arguments.tau_deg),
                       arguments.most_percent,
                       arguments.annotations,
                       {},
                       {}};
  for (const std::string& file : arguments.annotations) {
    const auto text = read_file(file, kMostAnnotationBytes);
    if (!text) return pass(text);
    auto read = evaluation::parse_annotations(*text, file);
    if (!read) return pass(read);
    out.annotations.push_back(std::move(*read));
  }
  return out;
}

void print_limbs(const evaluation::Judgement& found) {
  std::vector<std::vector<std::string>> rows{
      {"limb", "sensor", "in error %", "noise deg", "calibration deg", "own tau deg"}};
  for (const auto& limb : found.limbs)
    rows.push_back({std::string(words_for(limb.limb)), limb.calibration.sensor,
                    shown(error_percent(limb), 1), shown(to_deg(limb.floor.mean), 1),
                    shown(to_deg(limb.calibration.prediction_sigma), 1),
                    shown(to_deg(limb.own_tau), 0)});
  std::cout << table(rows);
  for (const Error& error : found.refused) std::cout << "not judged: " << to_string(error) << '\n';
}

/// The position errors of the limbs that are refereed.
void add_places(const EvaluateArguments& arguments, const Loaded& take,
                const evaluation::Judgement& found, const evaluation::BodyTrack& reference,
                RefereedTake& out) {
  const evaluation::BodyTrack tracked = places_of(take.joints);
  for (const auto& limb : out.limbs) {
    const auto judged = std::ranges::find(found.limbs, limb.limb, &evaluation::JudgedLimb::limb);
    out.places.push_back(evaluation::placed_limb(
        limb, *judged, evaluation::place_errors(limb.limb, tracked, reference),
        deg(arguments.tau_deg)));
  }
}

/// Errors of tracker and sensors against --reference; nothing without it.
Result<std::optional<RefereedTake>> refereed_take(const EvaluateArguments& arguments,
                                                  const Loaded& take,
                                                  const evaluation::Judgement& found) {
  if (arguments.reference.empty()) return std::nullopt;
  const auto reference = read_reference(
      {arguments.reference, arguments.reference_joints, arguments.out, arguments.reference_unit},
      take.joints);
  if (!reference) return pass(reference);
  for (const std::string& note : reference->notes) std::cerr << "note: " << note << '\n';
  RefereedTake out{
      arguments.reference,
      reference->shift,
      reference->joints,
      reference->rms,
      evaluation::refereed(found, take.body, take.sensors, reference->body, deg(arguments.tau_deg)),
      {}};
  if (out.limbs.empty())
    return fail(ErrorCode::NotFound, arguments.reference,
                "shows none of the limbs that are judged, while they are judged");
  std::vector<double> apart;
  for (const auto& limb : out.limbs) apart.push_back(to_deg(limb.tracker_spread.median));
  if (const double middle = median(std::move(apart)); middle > arguments.tau_deg)
    return fail(
        ErrorCode::Conflict, arguments.reference,
        fmt::format("its limbs are {:.0f} degrees from the tracker's in the median: does it "
                    "show the same motion?",
                    middle));
  add_places(arguments, take, found, reference->places, out);
  return out;
}

void print_reference(const RefereedTake& reference) {
  std::vector<std::vector<std::string>> rows{{"limb", "tracker off deg", "sensor off deg",
                                              "position off mm", "disagree", "tracker errs",
                                              "sensor errs"}};
  for (std::size_t i = 0; i < reference.limbs.size(); ++i) {
    const auto& limb = reference.limbs[i];
    const auto& place = reference.places[i];
    const auto count = [&](evaluation::Right right) {
      return std::to_string(
          std::ranges::count(limb.segments, right, &evaluation::RefereedSegment::right));
    };
    rows.push_back({std::string(words_for(limb.limb)), shown(to_deg(limb.tracker_spread.median), 1),
                    shown(to_deg(limb.sensor_spread.median), 1),
                    place.errors.empty() ? "-" : shown(to_mm(place.spread.median), 0),
                    std::to_string(limb.segments.size()), count(evaluation::Right::Sensor),
                    count(evaluation::Right::Tracker)});
  }
  std::cout << table(rows) << reference_verdict(reference) << '\n';
}

Result<int> run_evaluate(const EvaluateArguments& arguments) {
  auto inputs = inputs_of(arguments);
  if (!inputs) return pass(inputs);
  const evaluation::JudgeOptions options = options_of(arguments);
  std::vector<inertial::SensorCalibration> calibrations;
  if (!arguments.calibration.empty()) {
    const auto take = load(arguments.calibration, arguments.calibration_inertial, arguments);
    if (!take) return pass(take);
    auto found = evaluation::calibrate_take(take->body, take->sensors, options);
    if (!found) return pass(found);
    calibrations = std::move(*found);
  }
  const auto take = load(arguments.tracking, arguments.inertial, arguments);
  if (!take) return pass(take);
  const auto found = evaluation::judge_tracking(take->body, take->sensors, options, calibrations);
  if (!found) return tl::unexpected(with_clock_advice(found.error(), arguments));
  auto reference = refereed_take(arguments, *take, *found);
  if (!reference) return pass(reference);
  inputs->reference = std::move(*reference);
  const report::Report report = evaluation_report(*found, *inputs);
  if (auto ok = report::write_reports(report, arguments.out, "evaluation"); !ok) return pass(ok);
  if (arguments.json)
    std::cout << report::json_of(report) << '\n';
  else
    print_limbs(*found);
  if (inputs->reference && !arguments.json) print_reference(*inputs->reference);
  std::cerr << "wrote " << arguments.out << "/evaluation.html, .json and .csv\n";
  const bool good = std::ranges::all_of(found->limbs, [&](const auto& limb) {
    return error_percent(limb) <= arguments.most_percent;
  });
  return good ? kExitOk : kExitFailed;
}

void add_reference_options(CLI::App& options, EvaluateArguments& arguments) {
  auto* const reference =
      options.add_option("--reference", arguments.reference,
                         "Optical markers or joints of the same take (C3D, TRC, BVH, HTR, MVNX, or "
                         "fused frames of another tracker): "
                         "says who errs where tracker and sensor disagree");
  options
      .add_option(
          "--reference-unit", arguments.reference_unit,
          "Of the reference's lengths, where the file does not say, or is wrong: mm, cm, m, "
          "in, or a number of metres")
      ->needs(reference);
  options
      .add_option("--reference-joints", arguments.reference_joints,
                  "Lines such as \"HipLeft = LASI, LPSI\": points of the reference's joints, where "
                  "names do not say")
      ->needs(reference);
}

/// By which rules limbs are judged.
void add_judging_options(CLI::App& options, EvaluateArguments& arguments) {
  options.add_option("--tau", arguments.tau_deg, "Threshold [deg]")
      ->check(number_range(1.0, 180.0))
      ->capture_default_str();
  options
      .add_option("--most", arguments.most_percent, "Time in error that passes, of every limb [%]")
      ->check(number_range(0.0, 100.0))
      ->capture_default_str();
  options.add_flag("--stated", arguments.stated,
                   "Judge the orientations that the tracker states, not its joints");
  options.add_flag(
      "--same-clock", arguments.same_clock,
      "Tracker and sensors were recorded by one clock (always so in one file): no shift "
      "is looked for, which needs less movement");
  options.add_flag(
      "--from-start", arguments.from_start,
      "Judge the part that calibrates, too; limbs that hardly move in it are calibrated "
      "from more of the take");
}

}  // namespace

Run add_evaluate(CLI::App& options) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  options
      .add_option("--tracking", arguments->tracking,
                  "Fused frames: a recording, lines of JSON, or a fusion server's address")
      ->required();
  options
      .add_option(
          "--inertial", arguments->inertial,
          "Files of the sensors: MT Manager .txt, Movella DOT .csv, OpenSim .sto, .mvnx, or "
          "a recording that holds what they said")
      ->required();
  options.add_option("--limb", arguments->limbs,
                     "SENSOR=LIMB, where names do not say; else it is found");
  auto* const calibration = options.add_option("--calibration", arguments->calibration,
                                               "Another take that calibrates; else the first 35 %");
  options
      .add_option("--calibration-inertial", arguments->calibration_inertial,
                  "The sensors' files of that take")
      ->needs(calibration);
  options
      .add_option("--annotations", arguments->annotations,
                  "Files of annotators: limb,begin_s,end_s")
      ->expected(1, 2);
  add_reference_options(options, *arguments);
  options.add_option(
      "--person", arguments->person,
      "Who wears the sensors, of several people; else it is found from the movement");
  add_judging_options(options, *arguments);
  options.add_option("--seconds", arguments->seconds, "How long to listen to a server [s]")
      ->check(number_range(1.0, 3600.0))
      ->capture_default_str();
  add_authority_option(options);
  add_token_footer(options);
  options.add_option("--out", arguments->out, "Folder of the report")->capture_default_str();
  options.add_flag("--json", arguments->json, "Print the report as JSON");
  return [arguments] { return run_evaluate(*arguments); };
}

}  // namespace chorus::ctl
