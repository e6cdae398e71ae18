// Internal to the room: messages of a recording in, frames out, each in its own stream and in
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

/// What a clock model adds to capture times.
[[nodiscard]] Result<Duration> read_shift(std::string_view text);

/// False, with `t` unchanged, when the sum is outside the times we can represent.
[[nodiscard]] bool moved(Timestamp& t, const std::optional<Duration>& by);

class Sorting {
 public:
  explicit Sorting(const CellQuery& query) : query_(query) {}

  using Metadata = std::map<std::string, std::map<std::string, std::string>>;

  void begin_file(const std::filesystem::path& file, const std::vector<Channel>& channels,
                  const Metadata& metadata);
  [[nodiscard]] Result<std::optional<SessionItem>> take(const MessageView& message);
  /// `notes`: what reading it left out.
  [[nodiscard]] Result<void> end_file(const std::vector<Channel>& channels,
                                      const std::vector<std::string>& notes);
  /// All but the items.
  [[nodiscard]] CellRecording finish();

 private:
  using Item = Result<std::optional<SessionItem>>;

  /// The file being read.
  struct Source {
    std::filesystem::path file;
    std::string recording;       ///< The run it was recorded in, when that may have several files.
    std::string part;            ///< Which of them it is.
    FrameRecording description;  ///< What its metadata says of one sensor.
    bool single = false;         ///< The metadata names a sensor: /frame is its own.
  };
  /// Which files may follow each other: those of one recording, each part once.
  struct Line {
    std::string recording;
    std::set<std::string> parts;
    std::vector<std::filesystem::path> files;
    std::size_t newest = 0;  ///< Number of the last of them.
  };
  struct Stream {
    FrameRecording recording;  ///< Without its frames.
    Line line;
    std::optional<FloorPlane> floor;
    std::optional<Duration> shift;  ///< None: the times are in our clock already.
    std::size_t kept = 0;
    std::optional<Timestamp> newest;  ///< Of the frames kept.
    std::size_t left_out = 0;
    std::size_t kept_before = 0;          ///< How many frames there were when this file began.
    std::optional<Timestamp> newest_out;  ///< Of the frames of this file that were left out.
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
  std::size_t files_ = 0;   ///< Read so far, this one included.
  std::size_t frames_ = 0;  ///< Seen so far, on all topics.
  std::map<SensorId, Stream> streams_;
  Line fused_;
  std::string registration_;  ///< The newest.
  CellRecording out_;
};

}  // namespace chorus::record
