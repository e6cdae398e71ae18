// Internal to common/record: turns the messages of a recording into frames, separated by stream and
// checked for order.
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

/// The topic of the fused frames of a cell, or of the frames of a single sensor.
inline constexpr std::string_view kFusedTopic = "/frame";
inline constexpr std::string_view kSensorsPrefix = "/sensors/";

/// "/sensors/s1/clock" -> s1 and "clock"; "/frame" -> no id and "frame".
struct Topic {
  std::optional<SensorId> sensor;
  std::string_view what;
};
[[nodiscard]] std::optional<Topic> topic_of(std::string_view text);

/// The time that a clock model, as JSON, adds to capture times.
[[nodiscard]] Result<Duration> read_shift(std::string_view text);

/// The standard deviation of this time according to a clock model as JSON [s]; kUnknownClock if it
/// states none.
[[nodiscard]] double read_clock_sigma(std::string_view text);

/// Adds `by` to `t`; false, with `t` unchanged, when the sum is before 1970 or too large.
[[nodiscard]] bool moved(Timestamp& t, const std::optional<Duration>& by);

class Sorting {
 public:
  explicit Sorting(const CellQuery& query) : query_(query) {}

  using Metadata = std::map<std::string, std::map<std::string, std::string>>;

  void begin_file(const std::filesystem::path& file, const std::vector<Channel>& channels,
                  const Metadata& metadata);
  [[nodiscard]] Result<std::optional<SessionItem>> take(const MessageView& message);
  /// `notes`: what was left out when reading the file.
  [[nodiscard]] Result<void> end_file(const std::vector<Channel>& channels,
                                      const std::vector<std::string>& notes);
  /// Everything in the recording except the items that take() has returned.
  [[nodiscard]] CellRecording finish();

 private:
  using Item = Result<std::optional<SessionItem>>;

  /// The file being read.
  struct Source {
    std::filesystem::path file;
    std::string recording;       ///< The id of the run, if its recording may have several files.
    std::string part;            ///< Which part of the run it is.
    FrameRecording description;  ///< What the file's metadata say about one sensor.
    bool single = false;         ///< The metadata names one sensor, whose frames are on /frame.
  };
  /// Files that follow one another: the parts of one recording, each part once.
  struct Line {
    std::string recording;
    std::set<std::string> parts;
    std::vector<std::filesystem::path> files;
    std::size_t newest = 0;  ///< Value of files_ when the last of `files` was added.
  };
  struct Stream {
    FrameRecording recording;  ///< Without frames.
    Line line;
    std::optional<FloorPlane> floor;
    /// Time to add to capture times; none if they are already by the recorder's clock.
    std::optional<Duration> shift;
    double clock_sigma = kUnknownClock;
    std::size_t kept = 0;
    std::optional<Timestamp> newest;  ///< Capture time of the newest frame kept.
    std::size_t left_out = 0;
    std::size_t kept_before = 0;  ///< The value of `kept` when the current file began.
    /// Capture time of the newest frame of the current file that was left out.
    std::optional<Timestamp> newest_out;
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
  std::size_t files_ = 0;   ///< Number of files begun so far.
  std::size_t frames_ = 0;  ///< Number of frames so far, on all topics.
  std::map<SensorId, Stream> streams_;
  Line fused_;
  std::string registration_;  ///< The registration returned last, as JSON.
  CellRecording out_;
};

}  // namespace chorus::record
