#include "fusion-server/client/fused_frames.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "common/http/status.h"
#include "common/record/cell_stream.h"
#include "common/record/mcap_format.h"
#include "common/resource/frame_resource.h"
#include "fusion-server/client/live_poll.h"
#include "fusion-server/client/recordings.h"
#include "fusion-server/client/service_client.h"

namespace chorus::client {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFusedTopic = "/frame";
constexpr std::size_t kMaxLineBytes = 16u << 20;
constexpr std::size_t kMaxSamples = exporters::kMaxPoses;

void add_body(FusedSamples& samples, const resource::BodyResource& body, Timestamp instant) {
  exporters::FusedSample sample{instant, PersonId{body.id}, {}};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const resource::JointResource& joint = body.joints[j];
    sample.skeleton.joints[j] = {joint.position, joint.orientation, joint.state};
    if (joint.variance) sample.variance[j] = *joint.variance;
  }
  samples.push_back(sample);
}

tl::unexpected<Error> not_fused(const std::string& sensor, const std::string& at) {
  return fail(ErrorCode::Unsupported, at,
              fmt::format("is of sensor {} in its own space. Fuse first: chorus fuse DIR --out - "
                          "| chorus export - ...",
                          sensor));
}

Result<resource::FrameResource> world_frame(std::string_view json, const std::string& at) {
  auto frame = resource::read_frame(json, resource::Format::Json);
  if (!frame) return fail(frame.error().code, at, to_string(frame.error()));
  if (frame->space != resource::SpaceKind::World) return not_fused(frame->source, at);
  return frame;
}

Result<void> add_frame(FusedSamples& samples, const resource::FrameResource& frame,
                       const std::string& at) {
  if (samples.size() + frame.bodies.size() > kMaxSamples)
    return fail(ErrorCode::TooLarge, at, "is beyond the 500000 poses read at most.");
  for (const auto& body : frame.bodies) add_body(samples, body, frame.captured);
  return {};
}

TakeFrame into(FusedSamples& samples) {
  return [&samples](const resource::FrameResource& frame, const std::string& at) {
    return add_frame(samples, frame, at);
  };
}

/// Reads a recording file by file, and keeps none of its frames.
Result<Notes> each_of_recording(const std::string& source, const TakeFrame& take) {
  const auto files = find_recordings({source});
  if (!files) return pass(files);
  record::CellQuery query;
  query.fused = true;
  query.raw = false;
  record::CellStream stream(*files, query);
  std::size_t frames = 0;
  std::string raw;  // A sensor with raw frames, if one was found.
  for (auto item = stream.next(); true; item = stream.next()) {
    if (!item) return pass(item);
    if (!*item) break;
    if (const auto* sensor = std::get_if<SensorFrame>(&**item)) raw = sensor->sensor.str();
    const auto* fused = std::get_if<resource::FrameResource>(&**item);
    if (fused == nullptr) continue;
    ++frames;
    if (const auto taken = take(*fused, source); !taken) return pass(taken);
  }
  if (frames == 0 && !raw.empty()) return not_fused(raw, source);
  if (frames == 0)
    return fail(ErrorCode::NotFound, source,
                "holds no fused frames (topic /frame). Fuse its sensors: chorus fuse DIR --out - | "
                "chorus export - ...");
  return notes_of(stream.finish());
}

/// The lines of any stream; none is longer than kMaxLineBytes.
class Lines {
 public:
  explicit Lines(std::istream& in) : in_(in) {}

  /// Reads the next line; false at the end, or when a line is too long.
  bool next(std::string& line) {
    while (true) {
      const std::size_t end = rest_.find('\n', begin_);
      if (end != std::string::npos || ended_) {
        const bool there = begin_ < rest_.size();
        line = rest_.substr(begin_, end == std::string::npos ? end : end - begin_);
        begin_ = end == std::string::npos ? rest_.size() : end + 1;
        return there;
      }
      rest_.erase(0, begin_);
      begin_ = 0;
      if (rest_.size() > kMaxLineBytes) return too_long_ = true, false;
      std::array<char, 1u << 16> piece{};
      in_.read(piece.data(), piece.size());
      rest_.append(piece.data(), static_cast<std::size_t>(in_.gcount()));
      ended_ = in_.gcount() == 0;
    }
  }
  [[nodiscard]] bool too_long() const { return too_long_; }

 private:
  std::istream& in_;
  std::string rest_;
  std::size_t begin_ = 0;
  bool ended_ = false;
  bool too_long_ = false;
};

Result<Notes> each_of_lines(std::istream& in, const std::string& origin, const TakeFrame& take) {
  Lines reader(in);
  std::string line;
  for (std::size_t number = 1; reader.next(line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string at = fmt::format("{}:{}", origin, number);
    const auto frame = world_frame(line, at);
    if (!frame) return pass(frame);
    if (const auto taken = take(*frame, at); !taken) return pass(taken);
  }
  if (reader.too_long()) return fail(ErrorCode::TooLarge, origin, "has a line of more than 16 MB.");
  return Notes{};
}

Result<Notes> each_of_file(const std::string& source, const TakeFrame& take) {
  std::error_code ignored;
  if (fs::is_directory(source, ignored)) return each_of_recording(source, take);
  std::ifstream file(source, std::ios::binary);
  if (!file) return fail(ErrorCode::NotFound, source, "there is no such file or folder.");
  std::string start(record::mcap::kMagic.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start == record::mcap::kMagic) return each_of_recording(source, take);
  file.clear();
  file.seekg(0);
  return each_of_lines(file, source, take);
}

/// Receives a server's frames for some time, each frame once, by conditional long polling.
class Listening {
 public:
  Listening(const http::Url& server, std::string source, tls::Trust trust, TakeFrame taker)
      : source_(std::move(source)),
        taker_(std::move(taker)),
        poll_(io_, server, {std::string(kFusedTopic), "application/json", {}, std::move(trust)},
              {[this](const http::ClientResponse& answer) { take(answer); },
               [this](const Error& error, int status) { failed(error, status); }}) {}

  /// Ctrl-C ends the listening early, and keeps what was heard.
  Result<Notes> run(std::chrono::milliseconds listen) {
    asio::signal_set signals(io_, SIGINT, SIGTERM);
    signals.async_wait([this](const net::error_code& error, int) {
      if (error) return;
      stopped_ = true;
      io_.stop();
    });
    poll_.start();
    io_.run_for(listen);
    poll_.stop();
    if (fatal_) return tl::unexpected<Error>(*fatal_);
    if (count_.frames == 0 && !count_.error.empty())
      return fail(ErrorCode::Unavailable, source_, "delivered no frame; " + count_.error);
    return notes();
  }

 private:
  void end_with(Error error) {
    error.context = source_;
    if (count_.frames == 0) fatal_ = std::move(error);
    io_.stop();
  }

  void take(const http::ClientResponse& answer) {
    const auto frame = world_frame(answer.body, source_);
    if (!frame && frame.error().code == ErrorCode::Unsupported) return end_with(frame.error());
    if (!frame) return count_.cannot_read(frame.error());
    // A server without ETags may send the same frame again.
    if (count_.frames > 0 && frame->sequence == count_.last) return;
    if (auto taken = taker_(*frame, source_); !taken) {
      count_.cannot_read(taken.error());
      return end_with(taken.error());
    }
    count_.take(frame->sequence);
  }

  /// Gives up if no frame has come yet, unless the server says that it has none yet (503).
  void failed(const Error& error, int status) {
    count_.fail(error);
    if (count_.frames > 0 || status == http::status::kUnavailable) return;
    Error why = error;
    if (status == 0) why.message += "; is chorus-fusion running there?";
    end_with(std::move(why));
  }

  [[nodiscard]] Notes notes() const {
    Notes notes;
    if (stopped_) notes.emplace_back("stopped before --seconds had passed");
    if (count_.missed > 0) notes.push_back(fmt::format("{} frames were missed", count_.missed));
    if (count_.failed > 0) notes.push_back(fmt::format("{} requests failed", count_.failed));
    if (count_.unreadable > 0)
      notes.push_back(fmt::format("{} answers could not be used", count_.unreadable));
    if (!count_.error.empty()) notes.push_back("the last error: " + count_.error);
    return notes;
  }

  std::string source_;
  asio::io_context io_{1};
  TakeFrame taker_;
  LivePoll poll_;
  StreamCount count_;
  std::optional<Error> fatal_;
  bool stopped_ = false;
};

Result<Notes> listen_to(const std::string& source, std::chrono::milliseconds listen,
                        const TakeFrame& take) {
  auto url = http::parse_url(source);
  if (!url) return pass(url);
  std::string& path = url->target;
  while (path.ends_with('/')) path.pop_back();
  if (path.ends_with(kFusedTopic)) path.resize(path.size() - kFusedTopic.size());
  auto trust = authorities();
  if (!trust) return pass(trust);
  return Listening(*url, source, std::move(*trust), take).run(listen);
}

}  // namespace

std::string frame_line(const resource::FrameResource& frame) {
  std::string line = resource::write(frame, resource::Format::Json);
  while (line.ends_with('\n')) line.pop_back();
  return line + "\n";
}

Result<Notes> each_fused_frame(const std::string& source, std::chrono::milliseconds listen,
                               const TakeFrame& take) {
  if (source == "-") return each_of_lines(std::cin, "standard input", take);
  if (source.starts_with("http://") || source.starts_with("https://"))
    return listen_to(source, listen, take);
  return each_of_file(source, take);
}

Result<FusedSamples> read_fused_lines(std::istream& lines, const std::string& origin) {
  FusedSamples samples;
  const auto read = each_of_lines(lines, origin, into(samples));
  if (!read) return pass(read);
  return samples;
}

Result<FusedFrames> read_fused_frames(const std::string& source, std::chrono::milliseconds listen) {
  FusedFrames out;
  auto notes = each_fused_frame(source, listen, into(out.samples));
  if (!notes) return pass(notes);
  out.notes = std::move(*notes);
  return out;
}

}  // namespace chorus::client
