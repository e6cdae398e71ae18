#include "services/ctl/record/recorded_cell.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "common/record/cell_reader.h"
#include "common/record/frame_schema.h"
#include "common/record/recording_stream.h"
#include "common/time/clock_estimate.h"
#include "fusion-server/wire/registration_file.h"

namespace chorus::ctl {
namespace {

/// The next sensor frame of a cell; everything else in it is skipped.  None at the end.
Result<std::optional<SensorFrame>> next_frame(record::CellStream& stream, bool claims_time) {
  for (auto item = stream.next(); true; item = stream.next()) {
    if (!item) return pass(item);
    if (!*item) return std::nullopt;
    auto* frame = std::get_if<SensorFrame>(&**item);
    if (frame == nullptr) continue;
    if (!claims_time) frame->clock_sigma = kUnknownClock;
    return std::move(*frame);
  }
}

/// The next instant of worn inertial sensors, `later` by so much; none at the end.
Result<std::optional<inertial::InertialFrame>> next_suit(record::CellStream& stream,
                                                         Duration later) {
  for (auto item = stream.next(); true; item = stream.next()) {
    if (!item) return pass(item);
    if (!*item) return std::nullopt;
    auto* frame = std::get_if<inertial::InertialFrame>(&**item);
    if (frame == nullptr) continue;
    frame->captured += later;
    for (inertial::InertialReading& reading : frame->readings) reading.captured += later;
    return std::move(*frame);
  }
}

pipeline::InertialLane suit_lane(const record::CellLine& line, Duration later) {
  record::CellQuery query;
  query.inertial = true;
  query.raw = false;
  const auto stream = std::make_shared<record::CellStream>(line.files, query);
  return {line.files.front().string(), [stream, later] { return next_suit(*stream, later); }};
}

/// Whether the line's first file says that it holds what worn inertial sensors said.
bool names_suits(const record::CellLine& line) {
  const auto stream = record::RecordingStream::open(line.files.front());
  return stream && std::ranges::any_of(stream->channels(), [](const record::Channel& channel) {
           return channel.topic.starts_with("/inertial/");
         });
}

/// The note "set" of an import, which its files have in common; empty for what was recorded.
std::string import_of(const record::CellLine& line) {
  const auto stream = record::RecordingStream::open(line.files.front());
  if (!stream) return {};
  const auto found = stream->metadata().find(std::string(record::kMetadataName));
  if (found == stream->metadata().end()) return {};
  record::FrameRecording about;
  record::read_metadata(found->second, about);
  const auto set = about.notes.find("set");
  return set == about.notes.end() ? std::string() : set->second;
}

}  // namespace

Result<std::optional<std::filesystem::path>> registration_beside(
    const std::vector<std::filesystem::path>& files) {
  std::set<std::filesystem::path> found;
  for (const std::filesystem::path& file : files) {
    const auto beside = file.parent_path() / "registration.json";
    std::error_code unknown;
    if (std::filesystem::is_regular_file(beside, unknown)) found.insert(beside);
  }
  if (found.empty()) return std::nullopt;
  if (found.size() == 1) return *found.begin();
  return fail(ErrorCode::Conflict, "recordings",
              "several of their folders have a registration.json, such as " +
                  found.begin()->string() + " and " + found.rbegin()->string() +
                  "; name one with --registration, or register from the person with --from-walk");
}

RecordedCell::RecordedCell(std::vector<record::CellLine> lines) : lines_(std::move(lines)) {
  std::vector<std::string> imports;
  for (const record::CellLine& line : lines_) imports.push_back(import_of(line));
  const bool recorded = std::ranges::find(imports, "") != imports.end();
  for (const std::string& each : imports)
    claims_time_.push_back(each.empty() || (!recorded && each == imports.front()));
}

Result<RecordedCell> RecordedCell::open(const std::vector<std::filesystem::path>& files) {
  auto lines = record::cell_lines(files);
  if (!lines) return pass(lines);
  return RecordedCell(std::move(*lines));
}

Result<std::optional<Registration>> RecordedCell::registration() const {
  const auto text = record::last_registration(lines_);
  if (!text) return pass(text);
  if (!*text) return std::nullopt;
  auto registration = wire::read_registration(**text);
  if (!registration)
    return fail(registration.error().code, "/registration", to_string(registration.error()));
  return std::optional(std::move(*registration));
}

std::set<SensorId> RecordedCell::sensors() const {
  std::set<SensorId> all;
  for (const record::CellLine& line : lines_) all.insert(line.sensors.begin(), line.sensors.end());
  return all;
}

bool RecordedCell::holds_suits() const { return std::ranges::any_of(lines_, names_suits); }

Result<void> RecordedCell::wear(const std::vector<std::filesystem::path>& files, Duration later) {
  auto lines = record::cell_lines(files);
  if (!lines) return pass(lines);
  for (const record::CellLine& line : *lines) {
    if (!names_suits(line))
      return fail(ErrorCode::NotFound, line.files.front().string(),
                  "has no topic /inertial/{id}/orientations: make such a recording of a log with "
                  "`chorus import inertial`");
  }
  suits_ = std::move(*lines);
  later_ = later;
  return {};
}

std::vector<pipeline::InertialLane> RecordedCell::suits() const {
  std::vector<pipeline::InertialLane> lanes;
  for (const record::CellLine& line : lines_) {
    if (names_suits(line)) lanes.push_back(suit_lane(line, Duration{0}));
  }
  for (const record::CellLine& line : suits_) lanes.push_back(suit_lane(line, later_));
  return lanes;
}

pipeline::OfflineInput RecordedCell::input() {
  pipeline::OfflineInput input;
  streams_.clear();
  worn_->clear();
  input.inertial = suits();
  input.tell_worn = [worn = worn_](std::vector<WornReport> all) { *worn = std::move(all); };
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const record::CellLine& line = lines_[i];
    const auto stream = std::make_shared<record::CellStream>(line.files);
    const bool claims = claims_time_[i] && !clocks_dropped_;
    streams_.push_back(stream);
    input.lanes.push_back(
        {line.files.front().string(), [stream, claims] { return next_frame(*stream, claims); }});
    input.sensors.insert(input.sensors.end(), line.sensors.begin(), line.sensors.end());
  }
  return input;
}

RecordedCell::Told RecordedCell::told() {
  Told told;
  told.worn = *worn_;
  for (const auto& stream : streams_) {
    const record::CellRecording cell = stream->finish();
    told.sensors += cell.sensors.size();
    for (std::string& note : record::notes_of(cell)) told.notes.push_back(std::move(note));
  }
  return told;
}

}  // namespace chorus::ctl
