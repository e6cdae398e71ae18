// chorus score SOURCE: posture scores of a recording or of a running server, with their doubt.
#include <fstream>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/assessment/people.h"
#include "common/assessment/score_documents.h"
#include "common/assessment/sheet.h"
#include "common/base/file.h"
#include "common/record/recording.h"
#include "services/ctl/convert/fused_frames.h"
#include "services/ctl/evaluate/recorded_marks.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/server_option.h"
#include "services/ctl/line/text_file.h"

namespace chorus::ctl {
namespace {

constexpr std::uintmax_t kMaxTaskBytes = 2'000'000;

struct ScoreArguments {
  std::string source;
  std::string methods = "reba,rula,owas,iso11226,en1005-4,eaws-like";
  std::string task;
  std::string rules;
  std::string scene;
  std::string out = "-";
  std::string sheet;
  std::string angles;
  std::string language = "en";
  std::optional<std::uint64_t> person;
  double seconds = 10.0;
  bool no_stance = false;
};

Result<ergonomics::Task> task_of(const ScoreArguments& arguments, const FusedSpan& span) {
  if (arguments.task.empty()) return ergonomics::Task{};
  const auto text = read_file(arguments.task, kMaxTaskBytes);
  if (!text) return pass(text);
  const auto marks = marks_of(arguments.source, span);
  if (!marks) return pass(marks);
  return ergonomics::read_task(*text, arguments.task, *marks);
}

Result<std::vector<ergonomics::PostureRule>> rules_of(const ScoreArguments& arguments) {
  auto rules = ergonomics::shipped_rules();
  if (arguments.rules.empty()) return rules;
  const auto text = read_file(arguments.rules, kMaxTaskBytes);
  if (!text) return pass(text);
  auto own = ergonomics::read_rules(*text, arguments.rules);
  if (!own) return pass(own);
  rules.insert(rules.end(), own->begin(), own->end());
  return rules;
}

Result<std::optional<workplace::Scene>> scene_of(const ScoreArguments& arguments) {
  if (arguments.scene.empty()) return std::nullopt;
  const auto text = read_file(arguments.scene, kMaxTaskBytes);
  if (!text) return pass(text);
  auto scene = workplace::read_scene(*text, arguments.scene);
  if (!scene) return pass(scene);
  return std::move(*scene);
}

struct Read {
  assessment::People people;
  std::vector<std::string> notes;
};

Result<Read> read_people(const ScoreArguments& arguments) {
  Read read;
  const auto take = [&](const resource::FrameResource& frame, const std::string& at) {
    auto added = read.people.add(frame);
    if (!added) added = fail(added.error().code, at, to_string(added.error()));
    return added;
  };
  const auto listen = std::chrono::milliseconds(std::llround(arguments.seconds * 1e3));
  auto notes = each_fused_frame(arguments.source, listen, take);
  if (!notes) return pass(notes);
  read.notes = std::move(*notes);
  if (read.people.bodies().empty())
    return fail(ErrorCode::NotFound, arguments.source, "has nobody in any frame");
  if (!arguments.person || read.people.bodies().contains(*arguments.person)) return read;
  std::string known;
  for (const auto& [id, bodies] : read.people.bodies()) known += fmt::format(" {}", id);
  return fail(ErrorCode::NotFound, fmt::format("person {}", *arguments.person),
              "is not in these frames; there are:" + known);
}

/// Everything that was scored; `bodies` are kept for the pictures.
Result<assessment::Assessment> assessed(const ScoreArguments& arguments, const Read& read) {
  assessment::Assessment about;
  about.source = arguments.source;
  about.start = read.people.start();
  about.seconds = read.people.seconds();
  about.notes = read.notes;
  const auto methods = ergonomics::find_methods(arguments.methods);
  if (!methods) return pass(methods);
  about.methods = *methods;
  auto task = task_of(arguments, {about.start, about.seconds});
  if (!task) return pass(task);
  if (auto ok = ergonomics::fits(*task, about.seconds, arguments.task); !ok) return pass(ok);
  about.task = std::move(*task);
  auto scene = scene_of(arguments);
  if (!scene) return pass(scene);
  about.scene = std::move(*scene);
  const auto rules = rules_of(arguments);
  if (!rules) return pass(rules);
  for (const auto& [id, bodies] : read.people.bodies()) {
    if (arguments.person && id != *arguments.person) continue;
    std::optional<posture::Neutral> stance;
    if (!arguments.no_stance) {
      auto found = assessment::stance_of(bodies, about.task.stance, about.start);
      if (!found) return pass(found);
      stance = std::move(*found);
    }
    if (!stance)
      about.notes.push_back(fmt::format(
          "person {}: no upright stance; angles are absolute. Have them stand upright, arms down, "
          "for two seconds",
          id));
    about.persons.push_back(assessment::assess({id, bodies, stance}, about, *rules));
  }
  return about;
}

/// The scores as messages of a recording, in the order of time.
Result<void> write_recording(const assessment::Assessment& about, const std::string& file) {
  auto writer = record::RecordingWriter::create(file);
  if (!writer) return pass(writer);
  const auto channel = writer->add_channel({"/ergonomics", "chorus.Ergonomics", ""});
  if (!channel) return pass(channel);
  std::vector<record::Message> messages;
  for (const auto& person : about.persons) {
    for (std::size_t i = 0; i < person.scored.instants.size(); ++i) {
      const Timestamp at = person.scored.observations[i].at;
      messages.push_back({"/ergonomics", 0, at, at, assessment::instant_json(person, about, i)});
    }
  }
  std::ranges::stable_sort(messages, {}, &record::Message::log_time);
  for (std::uint32_t i = 0; i < messages.size(); ++i) {
    messages[i].sequence = i;
    if (auto ok = writer->write(*channel, messages[i]); !ok) return ok;
  }
  return writer->close();
}

Result<void> write_scores(const assessment::Assessment& about, const std::string& file) {
  if (file.ends_with(".mcap")) return write_recording(about, file);
  return write_text(file, file.ends_with(".csv") ? assessment::scores_csv(about)
                                                 : assessment::summary_json(about));
}

Result<void> write_sheet(const assessment::Assessment& about, const Read& read,
                         const ScoreArguments& arguments) {
  std::vector<assessment::SheetPerson> persons;
  for (const auto& person : about.persons)
    persons.push_back({person, read.people.bodies().at(person.id)});
  return write_text(arguments.sheet, assessment::sheet_html(about, persons,
                                                            arguments.language == "de"
                                                                ? assessment::Language::German
                                                                : assessment::Language::English));
}

Result<int> run_score(const ScoreArguments& arguments) {
  for (const std::string* file : {&arguments.out, &arguments.sheet, &arguments.angles}) {
    if (file->empty()) continue;
    if (auto ok =
            may_write(*file, {arguments.source, arguments.task, arguments.rules, arguments.scene});
        !ok)
      return pass(ok);
  }
  // Before the recording is read: a wrong name is told at once.
  if (const auto methods = ergonomics::find_methods(arguments.methods); !methods)
    return pass(methods);
  const auto read = read_people(arguments);
  if (!read) return pass(read);
  const auto about = assessed(arguments, *read);
  if (!about) return pass(about);
  if (auto ok = write_scores(*about, arguments.out); !ok) return pass(ok);
  if (!arguments.angles.empty()) {
    if (auto ok = write_text(arguments.angles, assessment::measures_csv(*about)); !ok)
      return pass(ok);
  }
  if (!arguments.sheet.empty()) {
    if (auto ok = write_sheet(*about, *read, arguments); !ok) return pass(ok);
  }
  for (const std::string& note : about->notes) std::cerr << "note: " << note << '\n';
  std::cerr << fmt::format("{} {}, {} frames, {:.1f} s\n", about->persons.size(),
                           about->persons.size() == 1 ? "person" : "persons", read->people.frames(),
                           about->seconds);
  for (const std::string* file : {&arguments.out, &arguments.angles, &arguments.sheet}) {
    if (!file->empty() && *file != "-") std::cerr << "wrote " << *file << '\n';
  }
  return kExitOk;
}

}  // namespace

Run add_score(CLI::App& options) {
  const auto arguments = std::make_shared<ScoreArguments>();
  options
      .add_option(
          "source", arguments->source,
          "Fused recording (.mcap or a folder of them), NDJSON of chorus fuse, - for NDJSON "
          "on standard input, or http://HOST:PORT/ of a fusion server")
      ->required();
  options.add_option("--method", arguments->methods, "Methods, by commas")->capture_default_str();
  options.add_option("--task", arguments->task,
                     "What no tracker sees: loads, grips, phases (docs/guide/ergonomics.md)");
  options.add_option("--rules", arguments->rules, "More named postures, a text file of rules");
  options.add_option("--scene", arguments->scene,
                     "The workplace: points to reach, boxes to see, things in hands "
                     "(deploy/workplaces)");
  options
      .add_option("--out", arguments->out,
                  "Scores: .csv (every instant), .mcap (a channel), else a summary as JSON")
      ->capture_default_str();
  options.add_option("--sheet", arguments->sheet, "Filled assessment sheets, as an HTML page");
  options.add_option("--language", arguments->language, "Of the sheets")
      ->check(CLI::IsMember({"en", "de"}))
      ->capture_default_str();
  options.add_option("--angles", arguments->angles, "All angles as CSV");
  options.add_option("--person", arguments->person, "Only the person of this id");
  options.add_flag("--no-stance", arguments->no_stance, "Absolute angles, not from the own stance");
  options.add_option("--seconds", arguments->seconds, "How long to listen to a server [s]")
      ->check(number_range(0.1, 86'400.0))
      ->capture_default_str();
  add_authority_option(options);
  add_token_footer(options);
  return [arguments] { return run_score(*arguments); };
}

}  // namespace chorus::ctl
