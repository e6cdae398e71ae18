// Looks into a recording at any instant: what there is, and everything within a few seconds, as
// JSON for people's screens.  Times are seconds since the recording's first message, in the order
// in which things were recorded (log time).
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "common/record/recording_stream.h"

namespace chorus::record {

/// What a look at a stretch of the recording asks for [s].
struct Stretch {
  double from = 0.0;
  double to = 0.0;
  double every = 0.0;  ///< At most one frame of each stream per so many seconds; 0: all of them.
};

inline constexpr double kLongestStretch = 5.0;  ///< [s]
/// [bytes]; what is beyond comes next time.  1.45 MB took 65 ms to read.
inline constexpr std::size_t kMostStretch = 1u << 20;
inline constexpr std::size_t kMostPlaces = 256u << 10;  ///< [bytes] of registrations in an outline.

class RecordingView {
 public:
  /// `files`: of one recording; damaged parts are left out.  Malformed when no message can be read.
  [[nodiscard]] static Result<RecordingView> open(const std::vector<std::filesystem::path>& files);

  /// {"seconds": 20.1, "started": "2026-...", "fused": true, "sensors": ["s1"], "single": "s1",
  ///  "registrations": [{"seconds": 0, "registration": {...}}], "notes": [...]}; "single" only for
  /// the recording of one sensor, whose frames are in its own space.  Registrations are in the
  /// order of time, each of them different from the one before; those beyond kMostPlaces are left
  /// out, and a note says so.
  [[nodiscard]] std::string outline();

  /// {"from": 3, "to": 5, "messages": [{"seconds": 3.01, "topic": "/frame", "message": {...}}]}:
  /// frames and registrations of both instants and what lies between; instants before the beginning
  /// or after the end mean these.  Where the stretch was cut at kMostStretch, "to" is one
  /// nanosecond before the first message that was left out.  InvalidArgument for a stretch that
  /// ends before it begins, is longer than kLongestStretch, or is not finite.
  [[nodiscard]] Result<std::string> stretch(const Stretch& asked);

  /// The last fused frame (or the only sensor's frame) at or before this instant; NotFound if there
  /// is none within a second.
  [[nodiscard]] Result<std::string> frame_at(double seconds);

  [[nodiscard]] Timestamp first() const noexcept { return first_; }
  [[nodiscard]] double length() const;  ///< [s]

 private:
  struct Part {
    Timestamp first;
    RecordingStream stream;
  };
  explicit RecordingView(std::vector<Part> parts);

  void find_places();

  template <class Take>
  Result<void> each_between(Timestamp from, Timestamp to, const Take& take);

  std::vector<Part> parts_;
  Timestamp first_;
  Timestamp last_;
  std::string single_;  ///< The only sensor's id; empty for a cell.
  std::vector<Message> places_;
  bool places_left_out_ = false;
};

/// Copies what lies between two instants (times of the recordings' clock) into a new file, with
/// everything before it that is needed to understand it: where the sensors stand, their clocks,
/// floors and calibrations.  Conflict if `out` exists; NotFound if nothing lies between;
/// Unavailable if it was stopped or the disk is too full.  Leaves no file after an error.  Returns
/// the number of frames.
struct Cut {
  Timestamp from;
  Timestamp to;
  std::uintmax_t min_free_bytes = 0;  ///< Ends when less than this is free.
};
[[nodiscard]] Result<std::uint64_t> cut_recording(const std::vector<std::filesystem::path>& files,
                                                  const Cut& cut, const std::filesystem::path& out,
                                                  const std::stop_token& stop = {});

}  // namespace chorus::record
