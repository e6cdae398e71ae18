#include "common/record/fused_frames.h"

#include <array>
#include <fstream>
#include <iostream>
#include <system_error>
#include <variant>

#include "common/record/cell_reader.h"
#include "common/record/cell_stream.h"
#include "common/record/mcap_format.h"

#include <fmt/format.h>

namespace chorus::record {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxLineBytes = 16u << 20;

tl::unexpected<Error> not_fused(const std::string& sensor, const std::string& at) {
  return fail(ErrorCode::Unsupported, at,
              fmt::format("is of sensor {} in its own space. Fuse first: chorus fuse DIR --out "
                          "fused.mcap, and name fused.mcap",
                          sensor));
}

/// Reads a recording file by file, and keeps none of its frames.
Result<Notes> each_of_recording(const std::string& source, const TakeFrame& take) {
  const auto files = find_recordings({source});
  if (!files) return pass(files);
  CellQuery query;
  query.fused = true;
  query.raw = false;
  CellStream stream(*files, query);
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
                "holds no fused frames (topic /frame). Fuse its sensors: chorus fuse DIR --out "
                "fused.mcap, and name fused.mcap");
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

/// A /frame document begins with a brace, perhaps after a byte order mark and spaces.
bool may_be_lines(std::string_view start) {
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos ? start.size() > 0 : start[first] == '{';
}

}  // namespace

Result<resource::FrameResource> read_fused_frame(std::string_view json, const std::string& at) {
  auto frame = resource::read_frame(json, resource::Format::Json);
  if (!frame) return fail(frame.error().code, at, to_string(frame.error()));
  if (frame->space != resource::SpaceKind::World) return not_fused(frame->source, at);
  return frame;
}

Result<Notes> each_fused_line(std::istream& lines, const std::string& origin,
                              const TakeFrame& take) {
  Lines reader(lines);
  std::string line;
  for (std::size_t number = 1; reader.next(line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string at = fmt::format("{}:{}", origin, number);
    const auto frame = read_fused_frame(line, at);
    if (!frame) return pass(frame);
    if (const auto taken = take(*frame, at); !taken) return pass(taken);
  }
  if (reader.too_long()) return fail(ErrorCode::TooLarge, origin, "has a line of more than 16 MB.");
  return Notes{};
}

Result<Notes> each_fused_frame(const std::string& source, const TakeFrame& take) {
  if (source == "-") return each_fused_line(std::cin, "standard input", take);
  std::error_code ignored;
  if (fs::is_directory(source, ignored)) return each_of_recording(source, take);
  std::ifstream file(source, std::ios::binary);
  if (!file) return fail(ErrorCode::NotFound, source, "there is no such file or folder.");
  std::string start(mcap::kMagic.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start == mcap::kMagic) return each_of_recording(source, take);
  start.resize(static_cast<std::size_t>(file.gcount()));
  if (fs::is_regular_file(source, ignored) && !may_be_lines(start))
    return fail(
        ErrorCode::Malformed, source,
        "is neither a recording (.mcap) nor lines of /frame documents as chorus fuse writes "
        "them; files of other programs become recordings with chorus import");
  file.clear();
  file.seekg(0);
  return each_fused_line(file, source, take);
}

std::string frame_line(const resource::FrameResource& frame) {
  std::string line = resource::write(frame, resource::Format::Json);
  while (line.ends_with('\n')) line.pop_back();
  return line + "\n";
}

}  // namespace chorus::record
