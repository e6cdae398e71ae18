// The device `replay`: plays a recording in real time, with new stamps.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "common/base/config_reader.h"
#include "common/sensor/frame_source.h"
#include "common/synthetic/host_clock.h"
#include "common/time/clock.h"
#include "services/sensor/device/host_time.h"
#include "services/sensor/device/replay/replay_tape.h"

namespace chorus::sensor_service {

/// When the replay begins.
enum class ReplayEpoch {
  Now,         ///< The set begins when the service starts.
  AsRecorded,  ///< Captures keep their recorded times, but are delivered from now on.
};

struct ReplayOptions {
  std::filesystem::path recording = {};
  bool loop = true;
  double speed = 1.0;
  ReplayEpoch epoch = ReplayEpoch::Now;
  std::optional<Timestamp> epoch_at = {};  ///< Replaces `epoch`, for several processes.
  std::optional<Timestamp> origin = {};    ///< First capture of the set; none: as noted.
  std::optional<Duration> period = {};     ///< Length of the set; none: as noted.
};

/// Reads device.replay; mistakes are reported at their keys.
[[nodiscard]] ReplayOptions read_replay_options(ConfigReader& config);

/// Waits until the clock shows an instant; false when it is told to stop before that.
using WaitUntil = std::function<bool(std::stop_token, Timestamp)>;

/// The time of a replay.  Playing follows true time, so that people are where they were seen
/// together, whatever the hosts' clocks say; frames are stamped by the host's clock.
struct ReplayClock {
  std::shared_ptr<const Clock> world;
  WaitUntil wait;  ///< Until the world's clock shows it; empty: really waits.
  synthetic::HostClock host = {};
};

/// Makes the device; its frames carry the id `sensor`, whatever the recording says.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_replay(std::unique_ptr<ReplayTape> tape,
                                                               const ReplayOptions& options,
                                                               const SensorId& sensor,
                                                               ReplayClock time);

/// Reads device.replay and opens the recording it names; damage is logged.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_replay(ConfigReader& config,
                                                               const SensorId& sensor,
                                                               const HostTime& time);

}  // namespace chorus::sensor_service
