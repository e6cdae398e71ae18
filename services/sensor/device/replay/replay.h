// The device `replay`: plays a recording again in real time, with new stamps.
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

/// Where the replay begins on the clock.
enum class ReplayEpoch {
  Now,         ///< The first capture of the set happens as the service starts.
  AsRecorded,  ///< Captures keep their recorded times; they are delivered from now on.
};

struct ReplayOptions {
  std::filesystem::path recording = {};
  bool loop = true;
  double speed = 1.0;
  ReplayEpoch epoch = ReplayEpoch::Now;
  std::optional<Timestamp> epoch_at = {};  ///< Used instead of `epoch`, for several processes.
  std::optional<Timestamp> origin = {};    ///< First capture of the set; else as noted.
  std::optional<Duration> period = {};     ///< Length of the set; likewise.
};

/// Reads device.replay; mistakes are complained about at their keys.
[[nodiscard]] ReplayOptions read_replay_options(ConfigReader& config);

/// Waits until the clock shows an instant; false when asked to stop before.
using WaitUntil = std::function<bool(std::stop_token, Timestamp)>;

/// Where the replay's time comes from.  It follows true time, so that people are where they were
/// seen together whatever the hosts' clocks say; frames are stamped by the host's clock.
struct ReplayClock {
  std::shared_ptr<const Clock> world;
  WaitUntil wait;  ///< Until the world's clock shows it.  Empty: really waits.
  synthetic::HostClock host = {};
};

/// The device; frames carry the id `sensor` whatever the recording says.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_replay(std::unique_ptr<ReplayTape> tape,
                                                               const ReplayOptions& options,
                                                               const SensorId& sensor,
                                                               ReplayClock time);

/// Reads device.replay and the recording that it names; damage in it is logged.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_replay(ConfigReader& config,
                                                               const SensorId& sensor,
                                                               const HostTime& time);

}  // namespace chorus::sensor_service
