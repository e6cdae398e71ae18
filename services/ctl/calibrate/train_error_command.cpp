// chorus train-error REC --truth FILE --out FILE: learns how much the joints of single views err.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/duration.h"
#include "common/record/cell_reader.h"
#include "fusion-server/learn/error_file.h"
#include "fusion-server/learn/fit_errors.h"
#include "services/ctl/calibrate/recorded_places.h"
#include "services/ctl/calibrate/true_bodies.h"
#include "services/ctl/convert/fused_samples.h"
#include "services/ctl/convert/sniffed.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/offline_options.h"
#include "services/ctl/line/text_file.h"
#include "services/ctl/record/recorded_cell.h"

namespace chorus::ctl {
namespace {

constexpr double kSampleRate = 5.0;  // [Hz]; errors change slowly, so more says little more
constexpr double kLeastTime = 60.0;  // [s] of views, of a joint

struct TrainArguments {
  std::vector<std::string> inputs;
  std::string truth;
  std::string out;
  std::string model = "gamma";
  PlaceOptions places;
  OfflineOptions options;
  bool json = false;
};

/// What was found in the recordings, and how much of it could be used.
struct Gathered {
  std::vector<learn::ErrorSample> samples;
  std::size_t people = 0;     ///< Seen people at instants that were looked at.
  std::size_t known = 0;      ///< Of these, those whose true body is known.
  double rate = kSampleRate;  ///< Of these instants [Hz].
};

Result<Gathered> gather(RecordedCell& cell, const Registration& registration,
                        const pipeline::OfflineConfig& config, const TrueBodies& truth) {
  Gathered gathered;
  const auto step = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::llround(config.rate_hz / kSampleRate)));
  gathered.rate = config.rate_hz / static_cast<double>(step);
  std::size_t instants = 0;
  const auto done = pipeline::visit_recordings(
      cell.input(), registration, config,
      [&](const Snapshot& snapshot, const std::vector<Person>& people) -> Result<void> {
        if (instants++ % step != 0) return {};
        for (const Person& person : people) {
          if (person.views.empty()) continue;
          ++gathered.people;
          const auto exact = truth.at(snapshot.instant, person);
          if (!exact) continue;
          ++gathered.known;
          learn::add_samples(person, *exact, gathered.samples);
        }
        return {};
      });
  if (!done) return pass(done);
  return gathered;
}

Result<void> check(const Gathered& gathered, const TrainArguments& arguments) {
  if (gathered.people == 0)
    return fail(ErrorCode::NotFound, "recordings",
                "show nobody to the sensors that have a place; nothing can be learned");
  if (gathered.known == 0)
    return fail(ErrorCode::NotFound, arguments.truth,
                "has no body within 0.5 m of anybody whom the sensors see: its frames must be of "
                "the same time and in the same world; name that world's places with "
                "--registration");
  std::array<std::size_t, kJointCount> count{};
  for (const learn::ErrorSample& sample : gathered.samples) ++count[index_of(sample.joint)];
  const double longest = static_cast<double>(*std::ranges::max_element(count)) / gathered.rate;
  if (longest >= kLeastTime) return {};
  return fail(
      ErrorCode::InvalidArgument, "recordings",
      fmt::format("have {:.0f} s of views whose true joints are known, and {:.0f} s are the "
                  "least (30 s in two sensors): record several minutes, of more than one "
                  "person, who walk, turn and work where people will be",
                  longest, kLeastTime));
}

nlohmann::json summary_of(const Gathered& gathered, const fusion::ErrorPredictor& predictor,
                          const learn::FitOptions& constant) {
  const auto known =
      std::ranges::count_if(predictor.joints, [](const auto& joint) { return joint.has_value(); });
  nlohmann::json summary{{"samples", gathered.samples.size()},
                         {"joints", known},
                         {"knownPercent", 100.0 * static_cast<double>(gathered.known) /
                                              static_cast<double>(gathered.people)},
                         {"errorCm", 100.0 * learn::prediction_error(predictor, gathered.samples)}};
  if (const auto plain = learn::fit_errors(gathered.samples, constant))
    summary["constantErrorCm"] = 100.0 * learn::prediction_error(*plain, gathered.samples);
  return summary;
}

void print_summary(const nlohmann::json& summary, const std::vector<std::string>& notes,
                   const TrainArguments& arguments) {
  if (arguments.json) {
    nlohmann::json all = summary;
    all["notes"] = notes;
    std::cerr << all.dump(2) << '\n';
    return;
  }
  for (const std::string& note : notes) std::cerr << "note: " << note << '\n';
  std::cerr << fmt::format(
      "{} joints of views, {} joints learned; the truth knew {:.0f} % of the people seen\n"
      "predicts errors to {:.1f} cm in these recordings, one number per joint to {:.1f} cm; only "
      "other recordings tell what it is worth\nwrote {}\n",
      summary["samples"].get<std::size_t>(), summary["joints"].get<std::size_t>(),
      summary["knownPercent"].get<double>(), summary["errorCm"].get<double>(),
      summary.value("constantErrorCm", std::nan("")), arguments.out);
}

/// Refuses to write to any of the input files.
Result<void> check_output(const TrainArguments& arguments,
                          std::vector<std::filesystem::path> read) {
  for (const std::string& each :
       {arguments.truth, arguments.places.registration, arguments.options.config})
    read.emplace_back(each);
  return may_write(arguments.out, read);
}

Result<int> learn_from(const TrainArguments& arguments, RecordedCell& cell, const Places& places,
                       const pipeline::OfflineConfig& config) {
  auto truth = read_fused_frames(arguments.truth, std::chrono::milliseconds(0));
  if (!truth) return pass(truth);
  const auto gathered =
      gather(cell, *places.registration, config, TrueBodies(std::move(truth->samples)));
  if (!gathered) return pass(gathered);
  if (auto ok = check(*gathered, arguments); !ok) return pass(ok);
  learn::FitOptions options;
  const auto* const name = std::ranges::find(fusion::kPredictorNames, arguments.model);
  options.kind = static_cast<fusion::PredictorKind>(name - fusion::kPredictorNames.begin());
  options.least_samples = static_cast<std::size_t>(kLeastTime * gathered->rate);
  options.trained_on = fmt::format("{} joints of views; truth: {}", gathered->samples.size(),
                                   std::filesystem::path(arguments.truth).filename().string());
  const auto predictor = learn::fit_errors(gathered->samples, options);
  if (!predictor) return pass(predictor);
  if (auto ok = write_text(arguments.out, learn::write_predictor(*predictor)); !ok) return pass(ok);
  std::vector<std::string> notes = cell.told().notes;
  notes.insert(notes.end(), truth->notes.begin(), truth->notes.end());
  if (!places.note.empty()) notes.insert(notes.begin(), places.note);
  options.kind = fusion::PredictorKind::Constant;
  print_summary(summary_of(*gathered, *predictor, options), notes, arguments);
  return kExitOk;
}

Result<int> run_train_error(const TrainArguments& arguments) {
  const auto config = offline_config(arguments.options);
  if (!config) return pass(config);
  const auto files = record::find_recordings({arguments.inputs.begin(), arguments.inputs.end()});
  if (!files) return pass(files);
  if (auto ok = check_output(arguments, *files); !ok) return pass(ok);
  auto cell = RecordedCell::open(*files);
  if (!cell) return pass(cell);
  const auto places = places_of(arguments.places, *files, *cell, *config);
  if (!places) return pass(places);
  return learn_from(arguments, *cell, *places, *config);
}

}  // namespace

Run add_train_error(CLI::App& options) {
  const auto arguments = std::make_shared<TrainArguments>();
  options
      .add_option("recordings", arguments->inputs,
                  "Folders or .mcap files, of sensors of one kind or of whole cells")
      ->required();
  options
      .add_option("--truth", arguments->truth,
                  "Fused frames that are better than the sensors, of the same time and in the same "
                  "world: a recording, or NDJSON (truth.ndjson of chorus import)")
      ->required();
  options.add_option("--out", arguments->out, "Model file to write; - is standard output")
      ->required();
  const std::vector<std::string> models(fusion::kPredictorNames.begin(),
                                        fusion::kPredictorNames.end());
  options
      .add_option("--model", arguments->model,
                  "How errors follow from what is seen; boosting needs the package libxgboost0")
      ->check(CLI::IsMember(models))
      ->capture_default_str();
  add_place_options(options, arguments->places);
  add_offline_options(options, arguments->options);
  options.add_flag("--json", arguments->json, "Summary as JSON");
  return [arguments] { return sniffed(run_train_error(*arguments), arguments->inputs); };
}

}  // namespace chorus::ctl
