// Carries a PushSession as a dialogue: JSON messages in both directions, over a WebSocket or a
// local socket.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/http/dialogue.h"
#include "services/sensor/device/bridge/push_session.h"

namespace chorus::bridge {

/// Opens a dialogue; Unavailable when there are too many connections, or just after a flood.
[[nodiscard]] Result<std::unique_ptr<http::Dialogue>> open_dialogue(
    const std::shared_ptr<PushDesk>& desk, std::string via, std::string address);

}  // namespace chorus::bridge
