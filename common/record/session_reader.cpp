#include "common/record/session_reader.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/record/floor_message.h"
#include "common/record/frame_schema.h"
#include "common/resource/frame_resource.h"

namespace chorus::record {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFusedTopic = "/frame";
constexpr std::string_view kSensorsPrefix = "/sensors/";

Result<Duration> read_shift(const std::string& text) {
  constexpr std::int64_t kMost = 100ll * 365 * 24 * 3600 * 1'000'000'000;  // a hundred years
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto wrong = fail(ErrorCode::Malformed, "clock", "a clock model has no appliedNanoseconds");
  if (!json.is_object() || !json.contains("appliedNanoseconds")) return wrong;
  const auto& value = json["appliedNanoseconds"];
  if (!value.is_string()) return wrong;
  const auto& digits = value.get_ref<const std::string&>();
  std::int64_t ns = 0;
  const char* last = digits.data() + digits.size();
  const auto [end, error] = std::from_chars(digits.data(), last, ns);
  if (error != std::errc{} || end != last || ns > kMost || ns < -kMost) return wrong;
  return Duration(ns);
}

/// False, and `t` as it was, when the sum is no time we know.
bool moved(Timestamp& t, const std::optional<Duration>& by) {
  std::int64_t ns = 0;
  const std::int64_t shift = by ? by->count() : 0;
  if (__builtin_add_overflow(to_unix_ns(t), shift, &ns) || ns < 0) return false;
  t = from_unix_ns(ns);
  return true;
}

/// "/sensors/s1/clock" -> s1 and "clock"; "/frame" -> no id and "frame".
struct Topic {
  std::optional<SensorId> sensor;
  std::string_view what;
};
std::optional<Topic> topic_of(std::string_view text) {
  if (!text.starts_with(kSensorsPrefix)) {
    return text.starts_with('/') ? std::optional(Topic{{}, text.substr(1)}) : std::nullopt;
  }
  text.remove_prefix(kSensorsPrefix.size());
  const auto slash = text.find('/');
  const auto id = SensorId::parse(text.substr(0, slash));
  if (!id || slash == std::string_view::npos) return std::nullopt;
  return Topic{*id, text.substr(slash + 1)};
}

bool is_scene(std::string_view topic) {
  return topic.ends_with("/scene") || topic == "/transforms";
}

/// Messages in, streams out.
class Sorting {
 public:
  explicit Sorting(const SessionQuery& query) : query_(query) {}

  Result<void> add(Recording recording, const fs::path& file);
  Session finish();

 private:
  /// The file being read.
  struct Source {
    fs::path file;
    std::string recording;       ///< The run it was recorded in, when that may have several files.
    std::string part;            ///< Which of them it is.
    FrameRecording description;  ///< What its metadata says of one sensor.
    bool single = false;         ///< The metadata names a sensor: /frame is its own.
  };
  /// Which files may follow each other: those of one recording, each part once.
  struct Line {
    std::string recording;
    std::set<std::string> parts;
    std::vector<fs::path> files;
    std::size_t newest = 0;  ///< Number of the last of them.
  };
  struct Stream {
    FrameRecording recording;
    Line line;
    std::optional<FloorPlane> floor;
    std::optional<Duration> shift;  ///< None: the times are ours already.
    std::size_t left_out = 0;
    std::size_t kept_before = 0;          ///< Frames there were when this file began.
    std::optional<Timestamp> newest_out;  ///< Of the frames of this file that were left out.
  };

  void describe(const Recording& recording);
  Result<void> take(const Message& message);
  Result<void> take_state(const Message& message, const Topic& topic);
  Result<void> take_frame(const Message& message, const Topic& topic);
  Result<void> append(Stream& stream, SensorFrame frame) const;
  Result<Stream*> stream_of(const SensorId& sensor);
  [[nodiscard]] bool begins_or_follows(Line& line) const;
  [[nodiscard]] Result<void> check_order(const Stream& stream) const;
  [[nodiscard]] std::string where() const { return source_.file.string(); }

  const SessionQuery& query_;
  Source source_;
  std::size_t files_ = 0;   ///< Read so far, this one included.
  std::size_t frames_ = 0;  ///< Seen so far, on all topics.
  std::map<SensorId, Stream> streams_;
  Line fused_;
  Session out_;
};

void Sorting::describe(const Recording& recording) {
  for (const std::string& note : recording.notes)
    out_.damage.push_back(source_.file.filename().string() + ": " + note);
  for (const Channel& channel : recording.channels) {
    if (const auto topic = topic_of(channel.topic); topic && topic->sensor)
      out_.cell.insert(*topic->sensor);
  }
  const auto found = recording.metadata.find(std::string(kMetadataName));
  if (found == recording.metadata.end()) return;
  read_metadata(found->second, source_.description);
  source_.single = !source_.description.sensor.str().empty();
  const auto said = [&](const char* key) {
    const auto value = found->second.find(key);
    return value == found->second.end() ? std::string{} : value->second;
  };
  source_.recording = said("recording");
  source_.part = said("part");
}

/// False: this file is of another recording, or the same part once more.
bool Sorting::begins_or_follows(Line& line) const {
  if (line.newest == files_) return true;  // a file named twice is two files
  if (line.files.empty()) line.recording = source_.recording;
  const bool follows = !line.recording.empty() && line.recording == source_.recording &&
                       (source_.part.empty() || !line.parts.contains(source_.part));
  if (!line.files.empty() && !follows) return false;
  line.parts.insert(source_.part);
  line.files.push_back(source_.file);
  line.newest = files_;
  return true;
}

/// The stream, which this file begins or, as the next file of its recording, goes on with.
Result<Sorting::Stream*> Sorting::stream_of(const SensorId& sensor) {
  const auto [found, fresh] = streams_.try_emplace(sensor);
  Stream& stream = found->second;
  if (fresh) {
    if (source_.single) stream.recording = source_.description;
    stream.recording.sensor = sensor;
    stream.floor = stream.recording.floor;
  }
  if (stream.line.newest == files_) return &stream;
  if (!begins_or_follows(stream.line)) {
    return fail(ErrorCode::Conflict, where(),
                "is a recording of sensor " + sensor.str() + ", and so is " +
                    stream.line.files.back().string() +
                    "; they are not parts of one recording: name one of them");
  }
  stream.kept_before = stream.recording.frames.size();
  stream.newest_out.reset();
  return &stream;
}

Result<void> Sorting::append(Stream& stream, SensorFrame frame) const {
  auto& frames = stream.recording.frames;
  bool told = moved(frame.captured, stream.shift);
  for (BodyFrame& body : frame.bodies) told = moved(body.captured, stream.shift) && told;
  if (!told) {
    ++stream.left_out;
    return {};
  }
  frame.floor = stream.floor;
  if (frames.empty() || frame.captured > frames.back().captured) {
    frames.push_back(std::move(frame));
    return {};
  }
  if (!query_.strict || stream.shift) {  // a clock that was corrected may step back
    ++stream.left_out;
    stream.newest_out = std::max(stream.newest_out.value_or(frame.captured), frame.captured);
    return {};
  }
  const bool repeats = frame.captured == frames.back().captured;
  return fail(ErrorCode::Malformed, where(),
              "frame " + std::to_string(frames.size()) +
                  (repeats ? " repeats the capture time " : " goes back in time to ") +
                  to_iso8601(frame.captured));
}

Result<void> Sorting::take_frame(const Message& message, const Topic& topic) {
  const bool maybe_fused = !topic.sensor && !source_.single;
  ++frames_;
  if (maybe_fused && !query_.fused && message.data.find("\"WorldSpace\"") != std::string::npos)
    return {};
  auto frame = resource::read_frame(message.data, resource::Format::Json);
  if (!frame) {
    return fail(ErrorCode::Malformed, where(),
                "frame " + std::to_string(frames_ - 1) + ", on " + message.topic + ": " +
                    to_string(frame.error()));
  }
  if (maybe_fused && frame->space == resource::SpaceKind::World) {
    if (!begins_or_follows(fused_)) {
      return fail(ErrorCode::Conflict, where(),
                  "holds fused frames, and so does " + fused_.files.back().string() +
                      "; they are not parts of one recording: name one of them");
    }
    out_.fused.push_back(std::move(*frame));
    return {};
  }
  SensorId sensor = topic.sensor.value_or(source_.description.sensor);
  if (sensor.str().empty()) {
    if (const auto id = SensorId::parse(frame->source)) sensor = *id;
  }
  const auto stream = stream_of(sensor);
  if (!stream) return pass(stream);
  return append(**stream, resource::to_sensor_frame(*frame, sensor, message.log_time));
}

/// What holds for the frames after it.
Result<void> Sorting::take_state(const Message& message, const Topic& topic) {
  const auto stream = stream_of(topic.sensor ? *topic.sensor : source_.description.sensor);
  if (!stream) return pass(stream);
  if (topic.what == "clock") {
    const auto shift = read_shift(message.data);
    if (!shift) return fail(ErrorCode::Malformed, where(), shift.error().message);
    (*stream)->shift = *shift;
    return {};
  }
  const auto floor = read_floor_json(message.data);
  if (!floor) return fail(ErrorCode::Malformed, where(), floor.error().message);
  (*stream)->floor = *floor;
  return {};
}

Result<void> Sorting::take(const Message& message) {
  const auto topic = topic_of(message.topic);
  if (!topic) return {};
  if (topic->what == "frame") return take_frame(message, *topic);
  const bool floor = topic->what == "floor-plane";
  if (floor || (topic->what == "clock" && topic->sensor)) return take_state(message, *topic);
  auto& known = out_.registrations;
  const bool news = known.empty() || known.back() != message.data;
  if (message.topic == "/registration" && news) known.push_back(message.data);
  return {};
}

Result<void> Sorting::add(Recording recording, const fs::path& file) {
  source_ = {file, {}, {}, {}, false};
  ++files_;
  describe(recording);
  for (Message& message : recording.messages) {
    if (auto ok = take(message); !ok) return ok;
    std::string().swap(message.data);  // the frame read is smaller than its text
  }
  for (const auto& [sensor, stream] : streams_) {
    if (auto ok = check_order(stream); !ok) return ok;
  }
  return {};
}

/// A part of which nothing could be used is no part of what came before, whatever it says.
Result<void> Sorting::check_order(const Stream& stream) const {
  const auto& frames = stream.recording.frames;
  const bool unused = stream.line.newest == files_ && stream.line.files.size() > 1 &&
                      frames.size() == stream.kept_before && stream.newest_out;
  if (!unused || frames.empty() || *stream.newest_out >= frames.back().captured) return {};
  return fail(
      ErrorCode::Conflict, where(),
      "all its frames of sensor " + stream.recording.sensor.str() + " are older than the end of " +
          stream.line.files[stream.line.files.size() - 2].string() + "; fuse the two one by one");
}

Session Sorting::finish() {
  // A recording of one sensor that saw nothing.
  if (streams_.empty() && frames_ == 0 && out_.cell.empty()) {
    streams_[source_.description.sensor].recording = source_.description;
  }
  for (auto& [sensor, stream] : streams_) {
    auto& notes = stream.recording.notes;
    for (std::size_t i = 0; i < out_.damage.size(); ++i)
      notes["damage." + std::to_string(i + 1)] = out_.damage[i];
    if (stream.left_out > 0)
      notes["left_out"] =
          std::to_string(stream.left_out) + " frames that go back in time or out of it";
    out_.sensors.push_back(std::move(stream.recording));
    out_.files[sensor] = std::move(stream.line.files);
  }
  return std::move(out_);
}

}  // namespace

Result<Session> read_session(const std::vector<fs::path>& files, const SessionQuery& query) {
  ReadLimits limits = query.limits;
  const std::string own = std::string(kSensorsPrefix) + query.only.str() + "/";
  limits.wanted = [&query, &own](std::string_view topic) {
    if (!query.raw) return topic == kFusedTopic;
    const bool others = !query.only.str().empty() && topic.starts_with(kSensorsPrefix);
    return !is_scene(topic) && (!others || topic.starts_with(own));
  };
  Sorting sorting(query);
  for (const fs::path& file : in_log_order(files)) {
    auto recording = read_recording(file, limits);
    if (!recording) return pass(recording);
    if (auto ok = sorting.add(std::move(*recording), file); !ok) return pass(ok);
  }
  return sorting.finish();
}

Result<Session> session_of(Recording recording, const fs::path& name, const SessionQuery& query) {
  Sorting sorting(query);
  if (auto ok = sorting.add(std::move(recording), name); !ok) return pass(ok);
  return sorting.finish();
}

Result<Session> read_session(const fs::path& path, const SessionQuery& query) {
  const auto files = recording_files(path);
  if (!files) return pass(files);
  return read_session(*files, query);
}

}  // namespace chorus::record
