#include "common/record/recording_view.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/record/free_space.h"
#include "common/record/recording_files.h"

namespace chorus::record {
namespace {

constexpr std::size_t kMostOfOneInstant = 4 * kMostStretch;  // [bytes]; the rest is left out
constexpr std::string_view kFrame = "/frame";
constexpr std::string_view kSensors = "/sensors/";
constexpr std::string_view kPlaces = "/registration";

bool is_frame(std::string_view topic) {
  return topic == kFrame || (topic.starts_with(kSensors) && topic.ends_with(kFrame));
}
bool is_shown(std::string_view topic) { return is_frame(topic) || topic == kPlaces; }
/// What holds until the next message of its topic; frames, readings and scenes do not.
bool holds_on(std::string_view topic) {
  return topic == kPlaces || topic.ends_with("/floor-plane") || topic.ends_with("/clock") ||
         topic.ends_with("/calibration");
}

/// The sensor of "/sensors/s1/frame".
std::string sensor_in_topic(std::string_view topic) {
  topic.remove_prefix(kSensors.size());
  return std::string(topic.substr(0, topic.find('/')));
}

Timestamp time_after(Timestamp start, double seconds) { return start + from_seconds(seconds); }

/// Whether it looks like one JSON object; reading all of it would take too long.
bool is_object(std::string_view text) {
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  return !text.empty() && text.front() == '{' && text[end] == '}';
}

}  // namespace

RecordingView::RecordingView(std::vector<Part> parts) : parts_(std::move(parts)) {}

Result<RecordingView> RecordingView::open(const std::vector<std::filesystem::path>& files) {
  ReadLimits limits;
  limits.wanted = is_shown;
  std::vector<Part> parts;
  std::optional<Timestamp> last;
  std::string single;
  for (const auto& file : in_log_order(files)) {
    auto stream = RecordingStream::open(file, limits);
    if (!stream) return pass(stream);
    const auto first = stream->next();
    if (!first) return pass(first);
    if (!*first) continue;
    const Timestamp begins = (*first)->log_time;
    for (const Channel& channel : stream->channels()) {
      const auto ends = is_shown(channel.topic) ? stream->last_of(channel.topic) : std::nullopt;
      if (ends) last = std::max(last.value_or(ends->log_time), ends->log_time);
    }
    const auto about = stream->metadata().find("chorus");
    if (about != stream->metadata().end()) {
      const auto id = about->second.find("sensor");
      if (id != about->second.end()) single = id->second;
    }
    parts.push_back({begins, std::move(*stream)});
  }
  if (parts.empty() || !last)
    return fail(ErrorCode::Malformed, files.empty() ? "recording" : files.front().string(),
                "holds no frame that can be read");
  RecordingView view(std::move(parts));
  view.first_ = view.parts_.front().first;
  view.last_ = std::max(*last, view.first_);
  view.single_ = std::move(single);
  view.find_places();
  return view;
}

/// Notes where sensors stood, whenever that changed; each part begins with a copy of what holds.
void RecordingView::find_places() {
  std::size_t bytes = 0;
  const auto take = [&](const MessageView& message) {
    if (!places_.empty() && places_.back().data == message.data) return true;
    bytes += message.data.size();
    places_left_out_ = bytes > kMostPlaces;
    if (!places_left_out_) places_.push_back(message.copy());
    return !places_left_out_;
  };
  for (Part& part : parts_)
    if (!places_left_out_) part.stream.each_of(kPlaces, take);
  std::ranges::stable_sort(places_, {}, &Message::log_time);
}

double RecordingView::length() const { return seconds(last_ - first_); }

/// Passes on the messages of the times [from, to], in order; `take` returns false to end this.
template <class Take>
Result<void> RecordingView::each_between(Timestamp from, Timestamp to, const Take& take) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].first > to) break;
    if (i + 1 < parts_.size() && parts_[i + 1].first < from) continue;
    RecordingStream& stream = parts_[i].stream;
    stream.rewind(from);
    while (true) {
      const auto message = stream.next();
      if (!message) return pass(message);
      if (!*message || (*message)->log_time > to) break;
      if ((*message)->log_time >= from && !take(**message)) return {};
    }
  }
  return {};
}

std::string RecordingView::outline() {
  nlohmann::json out{{"seconds", length()}, {"started", to_iso8601(first_)}, {"fused", false}};
  std::set<std::string> sensors;
  std::set<std::string> notes;
  for (Part& part : parts_) {
    for (const Channel& channel : part.stream.channels()) {
      if (channel.topic == kFrame && single_.empty()) out["fused"] = true;
      if (channel.topic != kFrame && is_frame(channel.topic))
        sensors.insert(sensor_in_topic(channel.topic));
    }
    notes.insert(part.stream.notes().begin(), part.stream.notes().end());
    if (part.stream.truncated())
      notes.insert("the file has no end: its last second may be missing");
  }
  if (!single_.empty()) {
    out["single"] = single_;
    sensors.insert(single_);
  }
  if (places_left_out_)
    notes.insert("the sensors' places change very often: after a jump they may be those of before");
  out["sensors"] = sensors;
  out["notes"] = notes;
  out["registrations"] = nlohmann::json::array();
  for (const Message& places : places_) {
    auto said = nlohmann::json::parse(places.data, nullptr, false);
    if (said.is_discarded()) continue;
    out["registrations"].push_back(
        {{"seconds", seconds(places.log_time - first_)}, {"registration", std::move(said)}});
  }
  return out.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

namespace {

/// The messages of a stretch as JSON, until they are kMostStretch.
struct Gathered {
  Timestamp first;
  Duration every;
  std::map<std::string, Timestamp, std::less<>> newest = {};
  std::string text = {};
  Timestamp last = first;
  std::optional<Timestamp> left_out = {};  ///< The first message for which there was no place.

  [[nodiscard]] bool too_early(const MessageView& message) const {
    if (every == Duration{0} || !is_frame(message.topic)) return false;
    const auto before = newest.find(message.topic);
    return before != newest.end() && message.log_time < before->second + every;
  }

  /// False: enough.  Messages of one instant stay together, because the next stretch begins with
  /// that instant and could otherwise end with it too.
  bool take(const MessageView& message) {
    if (too_early(message) || !is_object(message.data)) return true;
    if (text.size() >= kMostStretch && message.log_time > last) {
      left_out = message.log_time;
      return false;
    }
    if (text.size() >= kMostOfOneInstant) return true;
    last = message.log_time;
    newest.insert_or_assign(std::string(message.topic), message.log_time);
    text += fmt::format(R"({}{{"seconds":{:.4f},"topic":{},"message":)", text.empty() ? "" : ",\n",
                        seconds(message.log_time - first),
                        nlohmann::json(std::string(message.topic)).dump());
    text.append(message.data).append("}");
    return true;
  }
};

}  // namespace

Result<std::string> RecordingView::stretch(const Stretch& asked) {
  const double long_enough = asked.to - asked.from;
  if (!(long_enough >= 0.0) || long_enough > kLongestStretch || !(asked.every >= 0.0) ||
      !std::isfinite(asked.from) || !std::isfinite(asked.every))
    return fail(
        ErrorCode::InvalidArgument, "stretch",
        fmt::format("`from` and `to` are seconds, {} s apart at most; `every` is one of 0 s "
                    "or more",
                    kLongestStretch));
  const double from = std::clamp(asked.from, 0.0, length());
  double to = std::clamp(asked.to, 0.0, length());
  Gathered gathered{first_, from_seconds(std::min(asked.every, kLongestStretch))};
  const auto done =
      each_between(time_after(first_, from), time_after(first_, to),
                   [&](const MessageView& message) { return gathered.take(message); });
  if (!done) return pass(done);
  if (gathered.left_out) to = seconds(*gathered.left_out - first_ - Duration{1});
  // Exactly: a `to` that is rounded down would never reach the recording's end.
  return fmt::format(R"({{"from":{},"to":{},"messages":[{}]}})", from, to, gathered.text);
}

Result<std::string> RecordingView::frame_at(double seconds_in) {
  constexpr double kBack = 1.0;
  if (!std::isfinite(seconds_in))
    return fail(ErrorCode::InvalidArgument, "at", "the seconds since the recording's beginning");
  std::string frame;
  const auto take = [&](const MessageView& message) {
    if (message.topic == kFrame && is_object(message.data)) frame = message.data;
    return true;
  };
  if (seconds_in >= 0.0 && seconds_in <= length() + kBack) {
    const auto done =
        each_between(time_after(first_, seconds_in - kBack), time_after(first_, seconds_in), take);
    if (!done) return pass(done);
  }
  if (!frame.empty()) return frame;
  return fail(
      ErrorCode::NotFound, "at",
      fmt::format("no fused frame was recorded in the second before {:.3f} s; the recording "
                  "is {:.1f} s long",
                  seconds_in, length()));
}

namespace {

using Metadata = std::map<std::string, std::map<std::string, std::string>>;

/// What of the messages is copied, and where to.
struct Copy {
  RecordingWriter& writer;
  const Cut& cut;
  const std::filesystem::path folder;
  const std::stop_token& stop;
  Metadata metadata = {};  ///< Of the part that is read, until something is written.
  std::map<std::string, Channel, std::less<>> channels = {};
  std::map<std::string, std::uint16_t, std::less<>> known = {};
  std::map<std::string, Message, std::less<>> state = {};  ///< The newest before the cut, by topic.
  std::uint64_t frames = 0;
  std::uint64_t space_asked_at = 0;  ///< [bytes written]

  /// Whether it may go on; the disk is asked now and then.
  Result<void> may_go_on() {
    constexpr std::uint64_t kAskEvery = 8u << 20;
    if (stop.stop_requested()) return fail(ErrorCode::Unavailable, "cut", "it was stopped");
    if (writer.bytes() < space_asked_at) return {};
    space_asked_at = writer.bytes() + kAskEvery;
    return enough_space(folder, cut.min_free_bytes);
  }

  Result<void> put(const MessageView& message, Timestamp log_time) {
    for (const auto& [name, values] : std::exchange(metadata, {}))
      if (auto ok = writer.write_metadata(name, values); !ok) return ok;
    auto own = known.find(message.topic);
    if (own == known.end()) {
      const auto described = channels.find(message.topic);
      Channel channel = described == channels.end() ? Channel{std::string(message.topic), "", ""}
                                                    : described->second;
      const auto added = writer.add_channel(channel);
      if (!added) return pass(added);
      own = known.emplace(std::string(message.topic), *added).first;
    }
    Message copy = message.copy();
    copy.log_time = log_time;
    return writer.write(own->second, copy);
  }

  Result<void> put_state() {
    for (const auto& [topic, message] : std::exchange(state, {})) {
      const MessageView view{topic, message.sequence, message.log_time, message.publish_time,
                             message.data};
      if (auto ok = put(view, cut.from); !ok) return ok;
    }
    return {};
  }

  Result<void> take(const MessageView& message) {
    if (message.log_time < cut.from) {
      if (holds_on(message.topic))
        state.insert_or_assign(std::string(message.topic), message.copy());
      return {};
    }
    if (message.log_time > cut.to) return {};
    if (auto ok = put_state(); !ok) return ok;
    if (is_frame(message.topic)) ++frames;
    return put(message, message.log_time);
  }
};

Result<void> copy_file(const std::filesystem::path& file, Copy& copy) {
  auto stream = RecordingStream::open(file);
  if (!stream) return pass(stream);
  if (copy.known.empty()) copy.metadata = stream->metadata();
  while (true) {
    if (auto ok = copy.may_go_on(); !ok) return ok;
    const auto message = stream->next();
    if (!message) return pass(message);
    if (!*message || (*message)->log_time > copy.cut.to) return {};
    if (!copy.channels.contains((*message)->topic)) {
      for (const Channel& channel : stream->channels()) copy.channels[channel.topic] = channel;
    }
    if (auto ok = copy.take(**message); !ok) return ok;
  }
}

Result<std::uint64_t> copy_files(const std::vector<std::filesystem::path>& files, Copy& copy) {
  for (const auto& file : in_log_order(files))
    if (auto ok = copy_file(file, copy); !ok) return pass(ok);
  if (auto ok = copy.writer.close(); !ok) return pass(ok);
  if (copy.frames > 0) return copy.frames;
  return fail(ErrorCode::NotFound, "cut", "no frame was recorded between these instants");
}

}  // namespace

Result<std::uint64_t> cut_recording(const std::vector<std::filesystem::path>& files, const Cut& cut,
                                    const std::filesystem::path& out, const std::stop_token& stop) {
  auto writer = RecordingWriter::create(out);
  if (!writer) return pass(writer);
  Copy copy{*writer, cut, out.parent_path(), stop};
  auto frames = copy_files(files, copy);
  std::error_code failed;
  if (!frames) std::filesystem::remove(out, failed);
  return frames;
}

}  // namespace chorus::record
