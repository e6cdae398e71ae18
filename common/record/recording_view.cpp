#include "common/record/recording_view.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/record/recording_files.h"

namespace chorus::record {
namespace {

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
  return view;
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
  std::optional<Message> places;
  for (Part& part : parts_) {
    for (const Channel& channel : part.stream.channels()) {
      if (channel.topic == kFrame && single_.empty()) out["fused"] = true;
      if (channel.topic != kFrame && is_frame(channel.topic))
        sensors.insert(sensor_in_topic(channel.topic));
    }
    if (auto own = part.stream.last_of(kPlaces)) places = std::move(own);
    notes.insert(part.stream.notes().begin(), part.stream.notes().end());
    if (part.stream.truncated())
      notes.insert("the file has no end: its last second may be missing");
  }
  if (!single_.empty()) {
    out["single"] = single_;
    sensors.insert(single_);
  }
  out["sensors"] = sensors;
  out["notes"] = notes;
  if (places) out["registration"] = nlohmann::json::parse(places->data, nullptr, false);
  if (out.contains("registration") && out["registration"].is_discarded()) out.erase("registration");
  return out.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

Result<std::string> RecordingView::stretch(const Stretch& asked) {
  const double long_enough = asked.to - asked.from;
  if (!(long_enough >= 0.0) || long_enough > kLongestStretch || !(asked.every >= 0.0) ||
      !std::isfinite(asked.from))
    return fail(
        ErrorCode::InvalidArgument, "stretch",
        fmt::format("`from` and `to` are seconds, {} s apart at most; `every` is one of 0 s "
                    "or more",
                    kLongestStretch));
  std::map<std::string, Timestamp, std::less<>> newest;
  std::string messages;
  double to = asked.to;
  const auto done =
      each_between(time_after(first_, asked.from), time_after(first_, asked.to),
                   [&](const MessageView& message) {
                     const double at = seconds(message.log_time - first_);
                     const auto before = newest.find(message.topic);
                     if (asked.every > 0.0 && before != newest.end() && is_frame(message.topic) &&
                         message.log_time < time_after(before->second, asked.every))
                       return true;
                     if (!is_object(message.data)) return true;
                     newest.insert_or_assign(std::string(message.topic), message.log_time);
                     messages += fmt::format(R"({}{{"seconds":{:.4f},"topic":{},"message":)",
                                             messages.empty() ? "" : ",\n", at,
                                             nlohmann::json(std::string(message.topic)).dump());
                     messages.append(message.data).append("}");
                     if (messages.size() < kMostStretch) return true;
                     to = at;
                     return false;
                   });
  if (!done) return pass(done);
  return fmt::format(R"({{"from":{:.4f},"to":{:.4f},"messages":[{}]}})", asked.from, to, messages);
}

Result<std::string> RecordingView::frame_at(double seconds_in) {
  constexpr double kBack = 1.0;
  if (!std::isfinite(seconds_in))
    return fail(ErrorCode::InvalidArgument, "at", "the seconds since the recording's beginning");
  std::string frame;
  const auto done = each_between(time_after(first_, seconds_in - kBack),
                                 time_after(first_, seconds_in), [&](const MessageView& message) {
                                   if (message.topic == kFrame && is_object(message.data))
                                     frame = message.data;
                                   return true;
                                 });
  if (!done) return pass(done);
  if (!frame.empty()) return frame;
  return fail(
      ErrorCode::NotFound, "at",
      fmt::format("no fused frame was recorded in the second before {:.3f} s; the recording "
                  "is {:.1f} s long",
                  seconds_in, length()));
}

namespace {

/// What of the messages is copied, and where to.
struct Copy {
  RecordingWriter& writer;
  const Cut& cut;
  std::map<std::string, Channel, std::less<>> channels = {};
  std::map<std::string, std::uint16_t, std::less<>> known = {};
  std::map<std::string, Message, std::less<>> state = {};  ///< The newest before the cut, by topic.
  std::uint64_t frames = 0;

  Result<void> put(const MessageView& message, Timestamp log_time) {
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
  for (const auto& [name, values] : stream->metadata()) {
    if (copy.frames == 0 && copy.known.empty())
      if (auto ok = copy.writer.write_metadata(name, values); !ok) return ok;
  }
  while (true) {
    const auto message = stream->next();
    if (!message) return pass(message);
    if (!*message || (*message)->log_time > copy.cut.to) return {};
    if (!copy.channels.contains((*message)->topic)) {
      for (const Channel& channel : stream->channels()) copy.channels[channel.topic] = channel;
    }
    if (auto ok = copy.take(**message); !ok) return ok;
  }
}

}  // namespace

Result<std::uint64_t> cut_recording(const std::vector<std::filesystem::path>& files, const Cut& cut,
                                    const std::filesystem::path& out) {
  auto writer = RecordingWriter::create(out);
  if (!writer) return pass(writer);
  Copy copy{*writer, cut};
  for (const auto& file : in_log_order(files))
    if (auto ok = copy_file(file, copy); !ok) return pass(ok);
  if (auto ok = writer->close(); !ok) return pass(ok);
  if (copy.frames > 0) return copy.frames;
  std::error_code failed;
  std::filesystem::remove(out, failed);
  return fail(ErrorCode::NotFound, "cut", "no frame was recorded between these instants");
}

}  // namespace chorus::record
