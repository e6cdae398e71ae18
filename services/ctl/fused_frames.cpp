#include "services/ctl/fused_frames.h"

#include <array>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include <fmt/format.h>

#include "common/http/client.h"
#include "common/record/recording.h"
#include "common/resource/frame_resource.h"
#include "services/ctl/recordings.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFusedTopic = "/frame";
constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};
constexpr std::size_t kMaxLineBytes = 16u << 20;
constexpr std::size_t kMaxSamples = exporters::kMaxPoses;
constexpr int kOk = 200;
constexpr int kNotModified = 304;
constexpr int kUnavailable = 503;  // no frame yet

void add_body(FusedSamples& samples, const resource::BodyResource& body, Timestamp instant) {
  exporters::FusedSample sample{instant, PersonId{body.id}, {}};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const resource::JointResource& joint = body.joints[j];
    sample.skeleton.joints[j] = {joint.position, joint.orientation, joint.state};
    if (joint.variance) sample.variance[j] = *joint.variance;
  }
  samples.push_back(sample);
}

Result<void> add_frame(FusedSamples& samples, std::string_view json, const std::string& at) {
  const auto frame = resource::read_frame(json, resource::Format::Json);
  if (!frame) return fail(frame.error().code, at, to_string(frame.error()));
  if (frame->space != resource::SpaceKind::World)
    return fail(ErrorCode::Unsupported, at,
                fmt::format("is of sensor {} in its own space. Fuse first: chorus fuse DIR --out - "
                            "| chorus export - ...",
                            frame->source));
  if (samples.size() + frame->bodies.size() > kMaxSamples)
    return fail(ErrorCode::TooLarge, at, "is beyond the 500000 poses read at most.");
  for (const auto& body : frame->bodies) add_body(samples, body, frame->captured);
  return {};
}

Result<void> add_recording(FusedSamples& samples, const fs::path& file) {
  record::ReadLimits limits;
  limits.wanted = [](std::string_view topic) { return topic == kFusedTopic; };
  const auto recording = record::read_recording(file, limits);
  if (!recording) return pass(recording);
  std::size_t frames = 0;
  for (const record::Message& message : recording->messages) {
    const std::string at = fmt::format("{}: frame {}", file.string(), ++frames);
    if (auto added = add_frame(samples, message.data, at); !added) return added;
  }
  for (const std::string& note : recording->notes)
    std::cerr << fmt::format("note: {}: {}\n", file.string(), note);
  if (frames == 0)
    return fail(ErrorCode::NotFound, file.string(),
                "holds no fused frames (topic /frame). Fuse its sensors: chorus fuse DIR --out - | "
                "chorus export - ...");
  return {};
}

Result<FusedSamples> read_recording_files(const std::string& source) {
  const auto files = find_recordings({source});
  if (!files) return pass(files);
  FusedSamples samples;
  for (const fs::path& file : *files) {
    if (const auto added = add_recording(samples, file); !added) return pass(added);
  }
  return samples;
}

/// Lines of any stream, none longer than kMaxLineBytes.
class Lines {
 public:
  explicit Lines(std::istream& in) : in_(in) {}

  /// False at the end, or when a line is too long.
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

Result<FusedSamples> read_file(const std::string& source) {
  std::error_code ignored;
  if (fs::is_directory(source, ignored)) return read_recording_files(source);
  std::ifstream file(source, std::ios::binary);
  if (!file) return fail(ErrorCode::NotFound, source, "there is no such file or folder.");
  std::array<char, 8> start{};
  file.read(start.data(), start.size());
  if (std::string_view(start.data(), static_cast<std::size_t>(file.gcount())) == kMcapMagic)
    return read_recording_files(source);
  file.clear();
  file.seekg(0);
  return read_fused_lines(file, source);
}

/// The next frame by conditional long poll; an empty body when there was none in time.
Result<std::string> next_frame(const http::Url& url, std::string& etag, const std::string& where) {
  http::ClientRequest request;
  request.target = url.target;
  request.headers = {{"Accept", "application/json"}, {"Prefer", "wait=1"}};
  if (!etag.empty()) request.headers.push_back({"If-None-Match", etag});
  const auto answer = http::fetch(url, request);
  if (!answer)
    return fail(answer.error().code, where,
                answer.error().message + "; is chorus-fusion running there?");
  if (answer->status == kNotModified || answer->status == kUnavailable) return std::string();
  if (answer->status != kOk)
    return fail(ErrorCode::Unavailable, where,
                fmt::format("answers with status {}.", answer->status));
  const auto found = answer->headers.find("etag");
  if (found == answer->headers.end() || found->second == etag) return std::string();
  etag = found->second;
  return answer->body;
}

Result<FusedSamples> listen_to(const std::string& source, std::chrono::milliseconds listen) {
  auto url = http::parse_url(source);
  if (!url) return pass(url);
  while (url->target.ends_with('/')) url->target.pop_back();
  if (!url->target.ends_with(kFusedTopic)) url->target += kFusedTopic;
  FusedSamples samples;
  std::string etag;
  const auto until = std::chrono::steady_clock::now() + listen;
  while (std::chrono::steady_clock::now() < until) {
    const auto body = next_frame(*url, etag, source);
    if (!body) return pass(body);
    if (body->empty()) continue;
    if (const auto added = add_frame(samples, *body, source); !added) return pass(added);
  }
  return samples;
}

}  // namespace

Result<FusedSamples> read_fused_lines(std::istream& lines, const std::string& origin) {
  FusedSamples samples;
  Lines reader(lines);
  std::string line;
  for (std::size_t number = 1; reader.next(line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto added = add_frame(samples, line, fmt::format("{}:{}", origin, number));
    if (!added) return pass(added);
  }
  if (reader.too_long()) return fail(ErrorCode::TooLarge, origin, "has a line of more than 16 MB.");
  return samples;
}

Result<FusedSamples> read_fused_frames(const std::string& source,
                                       std::chrono::milliseconds listen) {
  if (source == "-") return read_fused_lines(std::cin, "standard input");
  if (source.starts_with("http://")) return listen_to(source, listen);
  return read_file(source);
}

}  // namespace chorus::ctl
