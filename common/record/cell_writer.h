// Writes a recording of a whole cell: what the sensors sent, what was fused from that, and
// everything that is needed to fuse it again.
//
//   /sensors/{id}/frame        chorus.Frame       as the sensor sent it: its own space and clock
//   /sensors/{id}/floor-plane  chorus.FloorPlane  when it changes
//   /sensors/{id}/clock        chorus.ClockModel  when what is added to its capture times changes,
//                                                 or whether its clock offset is known
//   /frame                     chorus.Frame       fused
//   /registration              chorus.Registration  when it changes
//   /marks                     chorus.Mark        an instant that somebody named
//   /inertial/{id}/orientations  chorus.Orientations  what worn inertial sensors say, as they sent
//   it /inertial/{id}/clock         chorus.ClockModel    as for a sensor /inertial/{id}/calibration
//   chorus.InertialCalibration  when it changes
// and for viewers /scene, /sensors/{id}/scene, /transforms (skeleton_scene.h).  A recording of a
// single sensor has its raw frames on /frame and its floor on /floor-plane (frame_recording.h).
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/inertial/calibration.h"
#include "common/record/marks.h"
#include "common/record/recording.h"
#include "common/record/skeleton_scene.h"
#include "common/resource/frame_resource.h"
#include "common/resource/orientations_resource.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::record {

/// How a sensor's capture times are converted to our clock.
struct ClockModel {
  Duration applied{0};  ///< Added to the sensor's capture times.
  Duration ours_minus_theirs{0};
  std::optional<Duration> uncertainty;  ///< None: the sensor's clock offset is unknown.
};

/// A stream's first frame that was captured longer than this before it was received is left over: a
/// sensor that has died, or has seen nothing since, still gives its last frame to whoever asks.
inline constexpr Duration kLeftOverAfter = std::chrono::seconds(10);

struct RawFrame {
  SensorId sensor;
  std::shared_ptr<const resource::FrameResource> frame;
  Timestamp received;  ///< Time of receipt, by our clock.
  std::optional<FloorPlane> floor;
  ClockModel clock;
};

struct RawOrientations {
  SensorId source;
  std::shared_ptr<const resource::OrientationsResource> orientations;
  Timestamp received;  ///< Time of receipt, by our clock.
  ClockModel clock;
};

/// How the sensors of an inertial source sit on a person, from now on.
struct CalibrationChanged {
  SensorId source;
  Timestamp at;
  inertial::InertialCalibration calibration;
};

struct FusedFrame {
  Timestamp instant;
  Timestamp published;
  std::function<resource::FrameResource()> frame;  ///< The writer calls it once.
};

struct PlacesChanged {
  Timestamp at;
  std::string registration;  ///< JSON, as in GET /registration or in the registration file.
  std::vector<NamedPlace> places;
};

struct CellHead {
  std::map<std::string, std::string> metadata;  ///< The content of the metadata record "chorus".
  bool single_sensor = false;                   ///< True: raw frames go to the topic /frame.
};

class CellWriter {
 public:
  [[nodiscard]] static Result<CellWriter> create(const std::filesystem::path& path,
                                                 const CellHead& head);

  [[nodiscard]] Result<void> write(const RawFrame& raw);
  [[nodiscard]] Result<void> write(const RawOrientations& raw);
  [[nodiscard]] Result<void> write(const CalibrationChanged& changed);
  [[nodiscard]] Result<void> write(const FusedFrame& fused);
  [[nodiscard]] Result<void> write(const PlacesChanged& places);
  [[nodiscard]] Result<void> write(const Marked& mark);
  /// Closes the open chunk and passes it to the operating system.
  [[nodiscard]] Result<void> flush() { return writer_.flush(); }
  /// Waits until the disk has stored what was flushed.
  [[nodiscard]] Result<void> sync() { return writer_.sync(); }
  [[nodiscard]] Result<void> close() { return writer_.close(); }

  [[nodiscard]] std::uint64_t bytes() const { return writer_.bytes(); }
  [[nodiscard]] std::uint64_t unpacked_bytes() const { return writer_.unpacked_bytes(); }

 private:
  struct Stream {
    std::optional<FloorPlane> floor;
  };
  struct Stamps {
    Timestamp logged;
    Timestamp published;
    std::uint64_t sequence = 0;
  };

  CellWriter(RecordingWriter writer, bool single_sensor)
      : writer_(std::move(writer)), single_sensor_(single_sensor) {}
  [[nodiscard]] Result<void> put(const std::string& topic, std::string_view schema,
                                 const Stamps& stamps, std::string text);
  [[nodiscard]] Result<void> write_clock(const SensorId& source, const ClockModel& clock,
                                         const std::string& prefix, const Stamps& stamps);
  [[nodiscard]] Result<void> write_state(const RawFrame& raw, const std::string& prefix,
                                         const Stamps& stamps);

  RecordingWriter writer_;
  bool single_sensor_;
  /// Channel numbers, by topic.
  std::map<std::string, std::uint16_t> channels_;
  std::map<SensorId, Stream> streams_;
  /// The clocks written last, by the prefix of their topic.
  std::map<std::string, ClockModel> clocks_;
};

}  // namespace chorus::record
