// Where the poses of a suit come from: a network stream or a file.
#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "common/base/result.h"
#include "common/time/clock.h"
#include "services/sensor/device/suit/suit_frames.h"
#include "services/sensor/device/suit/suit_settings.h"

namespace chorus::suit {

class SuitSource {
 public:
  /// `anew`: what was before holds no more, because a file starts again.
  using Take = std::function<void(const SuitInstant& instant, bool anew)>;

  virtual ~SuitSource() = default;
  /// Human-readable: what it is.
  [[nodiscard]] virtual std::string label() const = 0;
  /// Delivers poses in time order, when they happen, on the calling thread, until stopped or at the
  /// file's end.
  [[nodiscard]] virtual Result<void> run(const std::stop_token& stop, const Take& take) = 0;
  /// Human-readable: why no poses come; empty when they do.  From any thread.
  [[nodiscard]] virtual std::string trouble() const { return {}; }
  /// What would not work if it ran now.
  [[nodiscard]] virtual std::vector<std::string> concerns() const { return {}; }
};

/// A file is read at once; a socket is opened when the source runs.
[[nodiscard]] Result<std::unique_ptr<SuitSource>> open_suit(const SuitSettings& settings,
                                                            std::shared_ptr<const Clock> clock);

}  // namespace chorus::suit
