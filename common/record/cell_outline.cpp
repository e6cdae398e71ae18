#include "common/record/cell_outline.h"

#include <algorithm>
#include <utility>

#include "common/record/cell_sorting.h"
#include "common/record/cell_writer.h"
#include "common/record/frame_schema.h"
#include "common/resource/frame_resource.h"

namespace chorus::record {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRegistrationTopic = "/registration";

/// What a file says about itself.
struct FileHead {
  std::string recording;
  std::string part;
  FrameRecording description;
  std::set<SensorId> cell;  ///< The sensors of its raw streams, if the file is of a cell.
};

FileHead head_of(const RecordingStream& stream) {
  FileHead head;
  for (const Channel& channel : stream.channels()) {
    const auto topic = topic_of(channel.topic);
    if (topic && topic->sensor && topic->what == "frame") head.cell.insert(*topic->sensor);
  }
  const auto found = stream.metadata().find(std::string(kMetadataName));
  if (found == stream.metadata().end()) return head;
  read_metadata(found->second, head.description);
  const auto said = [&](const char* key) {
    const auto value = found->second.find(key);
    return value == found->second.end() ? std::string{} : value->second;
  };
  head.recording = said("recording");
  head.part = said("part");
  return head;
}

void add_file(CellLine& line, const fs::path& file, const FileHead& head,
              const std::vector<std::string>& notes) {
  for (const std::string& note : notes)
    line.damage.push_back(file.filename().string() + ": " + note);
  line.files.push_back(file);
  line.cell = line.cell || !head.cell.empty();
  line.sensors.insert(head.cell.begin(), head.cell.end());
  const SensorId& alone = head.description.sensor;
  if (!alone.str().empty()) line.sensors.insert(alone);
}

/// The capture time of a frame by the recorder's clock.
Result<Timestamp> captured(const Message& message, const std::optional<Message>& clock,
                           const fs::path& file) {
  const auto frame = resource::read_frame(message.data, resource::Format::Json);
  if (!frame) return fail(frame.error().code, file.string(), to_string(frame.error()));
  Timestamp t = frame->captured;
  if (!clock) return t;
  const auto shift = read_shift(clock->data);
  if (!shift) return fail(ErrorCode::Malformed, file.string(), shift.error().message);
  (void)moved(t, *shift);
  return t;
}

/// When a stream of a file begins and ends.
struct Extent {
  Timestamp first;
  Timestamp last;
  bool left_over = false;  ///< See SensorStay.
};

/// The second message of a topic; none if there is only one.
std::optional<Message> second_of(const fs::path& file, const std::string& topic) {
  ReadLimits limits;
  limits.wanted = [&](std::string_view one) { return one == topic; };
  auto stream = RecordingStream::open(file, limits);
  if (!stream) return std::nullopt;
  const auto first = stream->next();
  if (!first || !*first) return std::nullopt;
  const auto second = stream->next();
  return second && *second ? std::optional((*second)->copy()) : std::nullopt;
}

/// None when the file holds of this cell's stream only a frame that was left over, or nothing.
Result<std::optional<Extent>> extent_of(RecordingStream& stream, const std::string& prefix,
                                        bool cell, const fs::path& file) {
  const auto first = stream.first_of(prefix + "frame");
  const auto last = stream.last_of(prefix + "frame");
  if (!first || !last) return std::nullopt;
  const auto clock = cell ? stream.first_of(prefix + "clock") : std::nullopt;
  const auto begin = captured(*first, clock, file);
  const auto end = captured(*last, cell ? stream.last_of(prefix + "clock") : std::nullopt, file);
  if (!begin) return pass(begin);
  if (!end) return pass(end);
  const bool old = cell && first->log_time - *begin > kLeftOverAfter;
  if (!old) return Extent{*begin, *end};
  const auto second = second_of(file, prefix + "frame");
  if (!second) return std::nullopt;
  // If all frames are that old, the sensor's clock is wrong, and nothing was left over.
  if (last->log_time - *end > kLeftOverAfter) return Extent{*begin, *end};
  const auto next = captured(*second, clock, file);
  if (!next) return pass(next);
  return Extent{*next, *end, true};
}

/// Collects the time span of every sensor over all files.
class Stays {
 public:
  Result<void> add(const CellLine& line, std::size_t number) {
    for (const fs::path& file : line.files) {
      auto stream = RecordingStream::open(file);
      if (!stream) return pass(stream);
      const FileHead head = head_of(*stream);
      for (const SensorId& sensor : head.cell) {
        FrameRecording about;
        about.sensor = sensor;
        const std::string prefix = std::string(kSensorsPrefix) + sensor.str() + "/";
        if (auto ok = widen(*stream, {about, prefix, file, number, line.cell}); !ok) return ok;
      }
      if (!head.cell.empty()) continue;
      auto alone = sensor_of(*stream, head, file);
      if (!alone) return pass(alone);
      if (alone->str().empty()) continue;
      FrameRecording about = head.description;
      about.sensor = *alone;
      if (auto ok = widen(*stream, {about, "/", file, number, false}); !ok) return ok;
    }
    return {};
  }

  std::vector<SensorStay> take() {
    std::vector<SensorStay> all;
    for (auto& [sensor, known] : stays_) all.push_back(std::move(known.stay));
    return all;
  }

 private:
  struct Known {
    SensorStay stay;
    std::size_t line = 0;
  };
  struct Where {
    const FrameRecording& about;
    std::string prefix;  ///< The beginning of its topics.
    const fs::path& file;
    std::size_t line;
    bool cell;
  };

  /// The sensor of a file with one stream: the one in its metadata or, if there is none, the one in
  /// its frames.
  static Result<SensorId> sensor_of(RecordingStream& stream, const FileHead& head,
                                    const fs::path& file) {
    if (!head.description.sensor.str().empty()) return head.description.sensor;
    const auto message = stream.first_of(kFusedTopic);
    if (!message) return SensorId{};
    const auto frame = resource::read_frame(message->data, resource::Format::Json);
    if (!frame) return fail(frame.error().code, file.string(), to_string(frame.error()));
    if (frame->space == resource::SpaceKind::World) return SensorId{};
    return SensorId::parse(frame->source);
  }

  Result<void> widen(RecordingStream& stream, const Where& where) {
    const std::string topic = where.prefix + "frame";
    const auto extent = extent_of(stream, where.prefix, where.cell, where.file);
    if (!extent) return pass(extent);
    if (!*extent) return {};
    const auto [begin, end, left_over] = **extent;
    const auto [entry, fresh] = stays_.try_emplace(where.about.sensor);
    Known& known = entry->second;
    if (fresh) known = {{where.about, {}, begin, end, 0, where.cell, left_over}, where.line};
    if (known.line != where.line) {
      return fail(ErrorCode::Conflict, where.file.string(),
                  "is a recording of sensor " + where.about.sensor.str() + ", and so is " +
                      known.stay.files.back().string() +
                      "; they are not parts of one recording: name one of them");
    }
    SensorStay& stay = known.stay;
    stay.files.push_back(where.file);
    stay.first = std::min(stay.first, begin);
    stay.last = std::max(stay.last, end);
    auto frames = stream.count(topic);
    if (frames && left_over) --*frames;
    stay.frames = stay.frames && frames ? std::optional(*stay.frames + *frames) : std::nullopt;
    return {};
  }

  std::map<SensorId, Known> stays_;
};

}  // namespace

Result<std::vector<CellLine>> cell_lines(const std::vector<fs::path>& files) {
  std::vector<CellLine> lines;
  std::set<std::pair<std::string, std::string>> parts;
  for (const fs::path& file : in_log_order(files)) {
    const auto stream = RecordingStream::open(file);
    if (!stream) return pass(stream);
    const FileHead head = head_of(*stream);
    auto known = std::ranges::find(lines, head.recording, &CellLine::recording);
    if (head.recording.empty() || known == lines.end())
      known = lines.insert(lines.end(), {head.recording, {}, {}, false, {}});
    CellLine& line = *known;
    const bool numbered = !head.recording.empty() && !head.part.empty();
    if (numbered && !parts.insert({head.recording, head.part}).second) {
      return fail(ErrorCode::Conflict, file.string(),
                  "is the same part of a recording as one of the others; name one of them");
    }
    add_file(line, file, head, stream->notes());
  }
  return lines;
}

Result<std::optional<std::string>> last_registration(const std::vector<CellLine>& lines) {
  std::optional<Message> newest;
  ReadLimits limits;
  limits.wanted = [](std::string_view topic) { return topic == kRegistrationTopic; };
  for (const CellLine& line : lines) {
    for (auto file = line.files.rbegin(); file != line.files.rend(); ++file) {
      auto stream = RecordingStream::open(*file, limits);
      if (!stream) return pass(stream);
      auto found = stream->last_of(kRegistrationTopic);
      if (!found) continue;
      if (!newest || newest->log_time <= found->log_time) newest = std::move(found);
      break;
    }
  }
  if (!newest) return std::nullopt;
  return std::optional(std::move(newest->data));
}

Result<std::vector<SensorStay>> sensor_stays(const std::vector<CellLine>& lines) {
  Stays stays;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (auto ok = stays.add(lines[i], i); !ok) return pass(ok);
  }
  return stays.take();
}

}  // namespace chorus::record
