#include "common/record/cell_sorting.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/parse.h"
#include "common/record/floor_message.h"
#include "common/record/frame_schema.h"
#include "common/resource/frame_resource.h"
#include "common/resource/inertial_calibration_resource.h"
#include "common/resource/orientations_resource.h"

namespace chorus::record {
namespace {

namespace fs = std::filesystem;

/// A frame may arrive this much after a newer one of its sensor and still take its place, as in a
/// fusion server (align::HistoryLimits).
constexpr Duration kLatest = std::chrono::milliseconds(1500);
/// Most items that wait for late frames, whatever the log times say: 64 sensors deliver 2880 in
/// kLatest.
constexpr std::size_t kMostHeld = 4096;

/// Recognises fused frames by their space, which our documents state at the beginning.
bool says_world_space(std::string_view json) {
  constexpr std::size_t kHead = 512;
  constexpr std::string_view kWorld = "\"WorldSpace\"";
  return json.substr(0, kHead).find(kWorld) != std::string_view::npos ||
         json.find(kWorld) != std::string_view::npos;
}

}  // namespace

namespace {

/// The standard deviation of an imported sensor's capture times [s] by its notes; kUnknownClock for
/// what was not imported.
double imported_clock_sigma(const std::map<std::string, std::string>& notes) {
  constexpr double kOwnClock = 0.1;  // of a host whose clock somebody has set
  if (!notes.contains("set_origin")) return kUnknownClock;
  const auto clocks = notes.find("clocks");
  if (clocks == notes.end()) return 0.0;  // all imports had one clock before they said so
  if (clocks->second == "unknown") return kUnknownClock;
  return clocks->second == "own" ? kOwnClock : 0.0;
}

}  // namespace

Result<Duration> read_shift(std::string_view text) {
  constexpr std::int64_t kMax = 100ll * 365 * 24 * 3600 * 1'000'000'000;  // a hundred years
  const auto json = parse_json(text).value_or(nlohmann::json());
  const auto wrong = fail(ErrorCode::Malformed, "clock", "a clock model has no appliedNanoseconds");
  if (!json.is_object() || !json.contains("appliedNanoseconds")) return wrong;
  const auto& value = json["appliedNanoseconds"];
  if (!value.is_string()) return wrong;
  const auto& digits = value.get_ref<const std::string&>();
  const auto ns = parse_number<std::int64_t>(digits);
  if (!ns || *ns > kMax || *ns < -kMax) return wrong;
  return Duration(*ns);
}

double read_clock_sigma(std::string_view text) {
  const auto json = parse_json(text).value_or(nlohmann::json());
  const auto said = json.is_object() ? json.find("uncertaintyNanoseconds") : json.end();
  if (said == json.end() || !said->is_string()) return kUnknownClock;
  const auto ns = parse_number<std::int64_t>(said->get_ref<const std::string&>());
  if (!ns || *ns < 0) return kUnknownClock;
  return std::min(kUnknownClock, clock_sigma(ClockEstimate{Duration{0}, Duration(*ns)}));
}

bool moved(Timestamp& t, const std::optional<Duration>& by) {
  std::int64_t ns = 0;
  const std::int64_t shift = by ? by->count() : 0;
  if (__builtin_add_overflow(to_unix_ns(t), shift, &ns) || ns < 0) return false;
  t = from_unix_ns(ns);
  return true;
}

std::optional<Topic> topic_of(std::string_view text, std::string_view prefix) {
  if (!text.starts_with(prefix)) {
    return text.starts_with('/') ? std::optional(Topic{{}, text.substr(1)}) : std::nullopt;
  }
  text.remove_prefix(prefix.size());
  const auto slash = text.find('/');
  const auto id = SensorId::parse(text.substr(0, slash));
  if (!id || slash == std::string_view::npos) return std::nullopt;
  return Topic{*id, text.substr(slash + 1)};
}

void Sorting::note_cell(const std::vector<Channel>& channels) {
  for (const Channel& channel : channels) {
    if (const auto topic = topic_of(channel.topic); topic && topic->sensor)
      out_.cell.insert(*topic->sensor);
  }
}

void Sorting::begin_file(const fs::path& file, const std::vector<Channel>& channels,
                         const Metadata& metadata) {
  source_ = {file, {}, {}, {}, false};
  ++files_;
  note_cell(channels);
  const auto found = metadata.find(std::string(kMetadataName));
  if (found == metadata.end()) return;
  read_metadata(found->second, source_.description);
  source_.single = !source_.description.sensor.str().empty();
  const auto said = [&](const char* key) {
    const auto value = found->second.find(key);
    return value == found->second.end() ? std::string{} : value->second;
  };
  source_.recording = said("recording");
  source_.part = said("part");
}

/// Adds the current file to the line.  Returns false if the file belongs to another recording or
/// repeats a part.
bool Sorting::begins_or_follows(Line& line) const {
  if (line.newest == files_) return true;  // This very file has been added before.
  if (line.files.empty()) line.recording = source_.recording;
  const bool follows = !line.recording.empty() && line.recording == source_.recording &&
                       (source_.part.empty() || !line.parts.contains(source_.part));
  if (!line.files.empty() && !follows) return false;
  line.parts.insert(source_.part);
  line.files.push_back(source_.file);
  line.newest = files_;
  return true;
}

/// The sensor's stream: begun by this file, or continued if this file is another part of the same
/// recording.  Conflict if it is neither.
Result<Sorting::Stream*> Sorting::stream_of(const SensorId& sensor) {
  const auto [found, fresh] = streams_.try_emplace(sensor);
  Stream& stream = found->second;
  if (fresh) {
    if (source_.single) stream.recording = source_.description;
    stream.recording.sensor = sensor;
    stream.floor = stream.recording.floor;
    stream.clock_sigma = imported_clock_sigma(stream.recording.notes);
  }
  if (stream.line.newest == files_) return &stream;
  if (!begins_or_follows(stream.line)) {
    return fail(ErrorCode::Conflict, where(),
                "is a recording of sensor " + sensor.str() + ", and so is " +
                    stream.line.files.back().string() +
                    "; they are not parts of one recording: name one of them");
  }
  stream.kept_before = stream.kept;
  stream.newest_out.reset();
  return &stream;
}

/// True if the frame was overtaken on its way: it is numbered before the newest one, and not much
/// older.  A clock that was set back goes on counting.
bool Sorting::is_late(const Stream& stream, const SensorFrame& frame) const {
  return !query_.strict && frame.sequence < stream.newest_sequence &&
         frame.captured < *stream.newest && *stream.newest - frame.captured <= kLatest;
}

/// Puts a late frame before the frames that were captured after it.  Returns false if it is too
/// late for that, or if there is a frame of that time.
bool Sorting::put_in_place(Stream& stream, SensorFrame frame) {
  if (stream.given && *stream.given >= frame.captured) return false;
  const auto after = std::ranges::find_if(held_, [&](const Held& held) {
    const auto* other = std::get_if<SensorFrame>(&held.item);
    return other != nullptr && other->sensor == frame.sensor && other->captured >= frame.captured;
  });
  if (after != held_.end() && std::get<SensorFrame>(after->item).captured == frame.captured)
    return false;
  const Timestamp logged = after == held_.end() ? newest_logged_ : after->logged;
  held_.insert(after, Held{std::move(frame), logged});
  return true;
}

void Sorting::hold(SessionItem item, Timestamp logged) {
  newest_logged_ = std::max(newest_logged_, logged);
  held_.push_back({std::move(item), logged});
}

std::optional<SessionItem> Sorting::ready() {
  if (held_.empty()) return std::nullopt;
  const bool waits = !ended_ && !query_.strict && held_.size() <= kMostHeld &&
                     newest_logged_ - held_.front().logged <= kLatest;
  if (waits) return std::nullopt;
  SessionItem item = std::move(held_.front().item);
  held_.pop_front();
  if (const auto* frame = std::get_if<SensorFrame>(&item))
    streams_[frame->sensor].given = frame->captured;
  return item;
}

Result<void> Sorting::keep(Stream& stream, SensorFrame frame) {
  bool told = moved(frame.captured, stream.shift);
  for (BodyFrame& body : frame.bodies) told = moved(body.captured, stream.shift) && told;
  if (!told) {
    ++stream.left_out;
    return {};
  }
  frame.floor = stream.floor;
  frame.clock_sigma = stream.clock_sigma;
  const Timestamp captured = frame.captured;
  if (!stream.newest || captured > *stream.newest) {
    stream.newest = captured;
    stream.newest_sequence = frame.sequence;
    ++stream.kept;
    const Timestamp logged = frame.received;
    hold(std::move(frame), logged);
    return {};
  }
  if (is_late(stream, frame) && put_in_place(stream, std::move(frame))) {
    ++stream.kept;
    return {};
  }
  if (!query_.strict || stream.shift) {  // A corrected clock may step back.
    ++stream.left_out;
    stream.newest_out = std::max(stream.newest_out.value_or(captured), captured);
    return {};
  }
  const bool repeats = captured == *stream.newest;
  return fail(ErrorCode::Malformed, where(),
              "frame " + std::to_string(stream.kept) +
                  (repeats ? " repeats the capture time " : " goes back in time to ") +
                  to_iso8601(captured));
}

Result<void> Sorting::take_fused(resource::FrameResource frame, Timestamp logged) {
  if (!begins_or_follows(fused_)) {
    return fail(ErrorCode::Conflict, where(),
                "holds fused frames, and so does " + fused_.files.back().string() +
                    "; they are not parts of one recording: name one of them");
  }
  hold(std::move(frame), logged);
  return {};
}

Result<void> Sorting::take_frame(const MessageView& message, const Topic& topic) {
  const bool maybe_fused = !topic.sensor && !source_.single;
  ++frames_;
  if (maybe_fused && !query_.fused && says_world_space(message.data)) return {};
  auto frame = resource::read_frame(message.data, resource::Format::Json);
  if (!frame) {
    return fail(ErrorCode::Malformed, where(),
                "frame " + std::to_string(frames_ - 1) + ", on " + std::string(message.topic) +
                    ": " + to_string(frame.error()));
  }
  if (maybe_fused && frame->space == resource::SpaceKind::World)
    return take_fused(std::move(*frame), message.log_time);
  SensorId sensor = topic.sensor.value_or(source_.description.sensor);
  if (sensor.str().empty()) {
    if (const auto id = SensorId::parse(frame->source)) sensor = *id;
  }
  const auto stream = stream_of(sensor);
  if (!stream) return pass(stream);
  return keep(**stream, resource::to_sensor_frame(*frame, sensor, message.log_time));
}

/// Takes a message that states something about the frames after it.
Result<void> Sorting::take_state(const MessageView& message, const Topic& topic) {
  const auto stream = stream_of(topic.sensor ? *topic.sensor : source_.description.sensor);
  if (!stream) return pass(stream);
  if (topic.what == "clock") {
    const auto shift = read_shift(message.data);
    if (!shift) return fail(ErrorCode::Malformed, where(), shift.error().message);
    (*stream)->shift = *shift;
    (*stream)->clock_sigma = read_clock_sigma(message.data);
    return {};
  }
  const auto floor = read_floor_json(message.data);
  if (!floor) return fail(ErrorCode::Malformed, where(), floor.error().message);
  (*stream)->floor = *floor;
  return {};
}

Result<void> Sorting::take_orientations(const MessageView& message, const SensorId& source) {
  auto read = resource::read_orientations(message.data, resource::Format::Json);
  if (!read)
    return fail(ErrorCode::Malformed, where(),
                std::string(message.topic) + ": " + to_string(read.error()));
  const auto shift = inertial_shifts_.find(source);
  std::optional<Duration> by;
  if (shift != inertial_shifts_.end()) by = shift->second;
  for (inertial::InertialFrame& instant : read->instants) {
    instant.source = source;
    instant.received = message.log_time;
    bool told = moved(instant.captured, by);
    for (auto& reading : instant.readings) told = moved(reading.captured, by) && told;
    if (told) hold(std::move(instant), message.log_time);
  }
  return {};
}

/// Takes a message of an inertial source; `topic` is its id and what the message is.
Result<void> Sorting::take_inertial(const MessageView& message, const Topic& topic) {
  const SensorId& source = *topic.sensor;
  if (topic.what == "orientations") return take_orientations(message, source);
  if (topic.what == "clock") {
    const auto shift = read_shift(message.data);
    if (!shift) return fail(ErrorCode::Malformed, where(), shift.error().message);
    inertial_shifts_[source] = *shift;
    return {};
  }
  if (topic.what != "calibration") return {};
  auto calibration = resource::read_inertial_calibration(message.data, resource::Format::Json);
  if (!calibration)
    return fail(ErrorCode::Malformed, where(),
                std::string(message.topic) + ": " + to_string(calibration.error()));
  calibration->source = source.str();
  hold(std::move(*calibration), message.log_time);
  return {};
}

Result<void> Sorting::take(const MessageView& message) {
  if (message.topic.starts_with(kInertialPrefix)) {
    const auto inertial = topic_of(message.topic, kInertialPrefix);
    return query_.inertial && inertial ? take_inertial(message, *inertial) : Result<void>{};
  }
  const auto topic = topic_of(message.topic);
  if (!topic) return {};
  if (topic->what == "frame") return take_frame(message, *topic);
  const bool floor = topic->what == "floor-plane";
  if (floor || (topic->what == "clock" && topic->sensor)) return take_state(message, *topic);
  if (message.topic != "/registration" || registration_ == message.data) return {};
  registration_ = message.data;
  hold(registration_, message.log_time);
  return {};
}

Result<void> Sorting::end_file(const std::vector<Channel>& channels,
                               const std::vector<std::string>& notes) {
  note_cell(channels);
  for (const std::string& note : notes)
    out_.damage.push_back(source_.file.filename().string() + ": " + note);
  for (const auto& [sensor, stream] : streams_) {
    if (auto ok = check_order(stream); !ok) return ok;
  }
  return {};
}

/// Refuses a further file of a recording if no frame in it was kept and all of them are older than
/// the frames before it.
Result<void> Sorting::check_order(const Stream& stream) const {
  const bool unused = stream.line.newest == files_ && stream.line.files.size() > 1 &&
                      stream.kept == stream.kept_before && stream.newest_out;
  if (!unused || !stream.newest || *stream.newest_out >= *stream.newest) return {};
  return fail(
      ErrorCode::Conflict, where(),
      "all its frames of sensor " + stream.recording.sensor.str() + " are older than the end of " +
          stream.line.files[stream.line.files.size() - 2].string() + "; fuse the two one by one");
}

CellRecording Sorting::finish() {
  // A recording of one sensor that has no frames still yields that sensor.
  if (streams_.empty() && frames_ == 0 && out_.cell.empty()) {
    streams_[source_.description.sensor].recording = source_.description;
  }
  for (auto& [sensor, stream] : streams_) {
    auto& notes = stream.recording.notes;
    for (std::size_t i = 0; i < out_.damage.size(); ++i)
      notes["damage." + std::to_string(i + 1)] = out_.damage[i];
    if (stream.left_out > 0)
      notes["left_out"] = std::to_string(stream.left_out) +
                          (stream.left_out == 1 ? " frame" : " frames") +
                          " whose capture time is not later than that of the frame before (sent "
                          "twice, or the clock was set back)";
    out_.sensors.push_back(std::move(stream.recording));
    out_.files[sensor] = std::move(stream.line.files);
  }
  return std::move(out_);
}

}  // namespace chorus::record
