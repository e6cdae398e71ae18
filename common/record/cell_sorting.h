// Internal to common/record: turns the messages of a recording into frames, separated by stream and
// put into order.
#pragma once

#include <deque>
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
inline constexpr std::string_view kInertialPrefix = "/inertial/";

/// "/sensors/s1/clock" -> s1 and "clock"; "/frame" -> no id and "frame".  Below another prefix,
/// "/inertial/suit/clock" -> suit and "clock".
struct Topic {
  std::optional<SensorId> sensor;
  std::string_view what;
};
[[nodiscard]] std::optional<Topic> topic_of(std::string_view text,
                                            std::string_view prefix = kSensorsPrefix);

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
  [[nodiscard]] Result<void> take(const MessageView& message);
  /// The next item, once no late frame can come before it any more.
  [[nodiscard]] std::optional<SessionItem> ready();
  /// Call this after the last file: ready() then returns all that is left.
  void end() { ended_ = true; }
  /// `notes`: what was left out when reading the file.
  [[nodiscard]] Result<void> end_file(const std::vector<Channel>& channels,
                                      const std::vector<std::string>& notes);
  /// Everything in the recording except the items that ready() has returned.
  [[nodiscard]] CellRecording finish();

 private:
  /// An item that waits until no late frame can come before it any more.
  struct Held {
    SessionItem item;
    Timestamp logged;
  };

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
    std::optional<Timestamp> newest;    ///< Capture time of the newest frame kept.
    std::uint64_t newest_sequence = 0;  ///< Its number.
    std::optional<Timestamp> given;     ///< Capture time of the last frame that ready() returned.
    std::size_t left_out = 0;
    std::size_t kept_before = 0;  ///< The value of `kept` when the current file began.
    /// Capture time of the newest frame of the current file that was left out.
    std::optional<Timestamp> newest_out;
  };

  void note_cell(const std::vector<Channel>& channels);
  Result<void> take_state(const MessageView& message, const Topic& topic);
  Result<void> take_frame(const MessageView& message, const Topic& topic);
  Result<void> take_fused(resource::FrameResource frame, Timestamp logged);
  Result<void> take_inertial(const MessageView& message, const Topic& topic);
  Result<void> take_orientations(const MessageView& message, const SensorId& source);
  Result<void> keep(Stream& stream, SensorFrame frame);
  [[nodiscard]] bool is_late(const Stream& stream, const SensorFrame& frame) const;
  bool put_in_place(Stream& stream, SensorFrame frame);
  void hold(SessionItem item, Timestamp logged);
  Result<Stream*> stream_of(const SensorId& sensor);
  [[nodiscard]] bool begins_or_follows(Line& line) const;
  [[nodiscard]] Result<void> check_order(const Stream& stream) const;
  [[nodiscard]] std::string where() const { return source_.file.string(); }

  const CellQuery& query_;
  Source source_;
  std::size_t files_ = 0;   ///< Number of files begun so far.
  std::size_t frames_ = 0;  ///< Number of frames so far, on all topics.
  std::map<SensorId, Stream> streams_;
  std::map<SensorId, Duration> inertial_shifts_;  ///< As Stream::shift, by inertial source.
  Line fused_;
  std::string registration_;  ///< The registration read last, as JSON.
  std::deque<Held> held_;     ///< In log order, but for late frames.
  Timestamp newest_logged_ = Timestamp::min();
  bool ended_ = false;
  CellRecording out_;
};

}  // namespace chorus::record
