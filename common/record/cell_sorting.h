// Internal to the room: turns the messages of a recording into frames, sorted by stream and in
// order.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/record/cell_stream.h"
#include "common/record/recording_stream.h"
#include "common/time/clock_estimate.h"

namespace chorus::record {

/// "/frame": the fused frames of a cell, or the frames of a single sensor.
inline constexpr std::string_view kFusedTopic = "/frame";
inline constexpr std::string_view kSensorsPrefix = "/sensors/";

/// "/sensors/s1/clock" -> s1 and "clock"; "/frame" -> no id and "frame".
struct Topic {
  std::optional<SensorId> sensor;
  std::string_view what;
};
[[nodiscard]] std::optional<Topic> topic_of(std::string_view text);

/// The time that a clock model adds to capture times.
[[nodiscard]] Result<Duration> read_shift(std::string_view text);

/// How exact it says that is, as a standard deviation [s]; kUnknownClock when it does not say.
[[nodiscard]] double read_clock_sigma(std::string_view text);

/// False, with `t` unchanged, when the sum is beyond the times that we can represent.
[[nodiscard]] bool moved(Timestamp& t, const std::optional<Duration>& by);

class Sorting {
 public:
  explicit Sorting(const CellQuery& query) : query_(query) {}

  using Metadata = std::map<std::string, std::map<std::string, std::string>>;

  void begin_file(const std::filesystem::path& file, const std::vector<Channel>& channels,
                  const Metadata& metadata);
  [[nodiscard]] Result<std::optional<SessionItem>> take(const MessageView& message);
  /// `notes`: what reading the file left out.
  [[nodiscard]] Result<void> end_file(const std::vector<Channel>& channels,
                                      const std::vector<std::string>& notes);
  /// Everything except the items.
  [[nodiscard]] CellRecording finish();

 private:
  using Item = Result<std::optional<SessionItem>>;

  /// The file being read.
  struct Source {
    std::filesystem::path file;
    std::string recording;       ///< The run that it belongs to, if a run may have several files.
    std::string part;            ///< Which part of the run it is.
    FrameRecording description;  ///< What its metadata says about one sensor.
    bool single = false;         ///< The metadata names one sensor, whose frames are on /frame.
  };
  /// Files that may follow one another: the parts of one recording, each once.
  struct Line {
    std::string recording;
    std::set<std::string> parts;
    std::vector<std::filesystem::path> files;
    std::size_t newest = 0;  ///< Number of its last file.
  };
  struct Stream {
    FrameRecording recording;  ///< Without frames.
    Line line;
    std::optional<FloorPlane> floor;
    std::optional<Duration> shift;  ///< None: the times are already in our clock.
    double clock_sigma = kUnknownClock;
    std::size_t kept = 0;
    std::optional<Timestamp> newest;  ///< Of the frames that were kept.
    std::size_t left_out = 0;
    std::size_t kept_before = 0;          ///< Number of frames when this file began.
    std::optional<Timestamp> newest_out;  ///< Of the frames left out in this file.
  };

  void note_cell(const std::vector<Channel>& channels);
  Result<void> take_state(const MessageView& message, const Topic& topic);
  Item take_frame(const MessageView& message, const Topic& topic);
  Item take_fused(resource::FrameResource frame);
  Item kept(Stream& stream, SensorFrame frame) const;
  Result<Stream*> stream_of(const SensorId& sensor);
  [[nodiscard]] bool begins_or_follows(Line& line) const;
  [[nodiscard]] Result<void> check_order(const Stream& stream) const;
  [[nodiscard]] std::string where() const { return source_.file.string(); }

  const CellQuery& query_;
  Source source_;
  std::size_t files_ = 0;   ///< Number of files so far, with this one.
  std::size_t frames_ = 0;  ///< Number of frames so far, on all topics.
  std::map<SensorId, Stream> streams_;
  Line fused_;
  std::string registration_;  ///< The newest one.
  CellRecording out_;
};

}  // namespace chorus::record
