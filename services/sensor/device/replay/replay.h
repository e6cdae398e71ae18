// The device `replay`: plays a recording, by default in real time and with new time stamps.
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
  Now,         ///< The set begins when the device starts.
  AsRecorded,  ///< Captures keep their recorded times; delivery begins when the device starts.
};

struct ReplayOptions {
  std::filesystem::path recording = {};
  bool loop = true;
  double speed = 1.0;
  ReplayEpoch epoch = ReplayEpoch::Now;
  /// If set, replaces `epoch`; for several processes that play in step.
  std::optional<Timestamp> epoch_at = {};
  /// First capture time of the set; none: as the recording notes it, or that of its first frame.
  std::optional<Timestamp> origin = {};
  /// Length of the set; none: as the recording notes it, or as long as it lasts.
  std::optional<Duration> period = {};
};

/// Reads device.replay; the reader's finish() reports mistakes.
[[nodiscard]] ReplayOptions read_replay_options(ConfigReader& config);

/// Waits until the clock shows an instant; false when told to stop before.
using WaitUntil = std::function<bool(std::stop_token, Timestamp)>;

/// The time of a replay.  Playing follows true time, so that the replays of several hosts show the
/// same moment, whatever these hosts' clocks say.  Frames are stamped by the host's clock.
struct ReplayClock {
  std::shared_ptr<const Clock> world;
  WaitUntil wait;  ///< Waits until `world` shows an instant; empty: really waits.
  synthetic::HostClock host = {};
};

/// Makes the device; its frames have the id `sensor`, whatever the recording says.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> make_replay(std::unique_ptr<ReplayTape> tape,
                                                               const ReplayOptions& options,
                                                               const SensorId& sensor,
                                                               ReplayClock time);

/// Reads device.replay and opens the recording that it names; logs damage.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_replay(ConfigReader& config,
                                                               const SensorId& sensor,
                                                               const HostTime& time);

}  // namespace chorus::sensor_service
