// A page that sends photos of hands over a WebSocket, and gets skeletons or refusals.
//
//   -> {"type": "scan", "scale": "a4" | "card" | "none", "view": "palm" | "back", "photo": BASE64}
//   <- {"type": "hand", "bvh": TEXT, "htr": TEXT, "picture": BASE64 (JPEG), "report": {...}}
//   <- {"type": "refused", "code": ..., "context": ..., "detail": ...}
//
// One photo at a time; the answer comes within seconds.  Nothing is kept.
#pragma once

#include <memory>

#include "common/http/dialogue.h"
#include "services/sensor/device/scan/scan_desk.h"

namespace chorus::scan {

/// Of one message: a photo of about four megabytes.
inline constexpr std::size_t kMaxScanMessage = 6u << 20;

[[nodiscard]] std::unique_ptr<http::Dialogue> scan_dialogue(std::shared_ptr<ScanDesk> desk);

/// The route of such dialogues.
[[nodiscard]] http::DialogueRoute scan_route(std::shared_ptr<ScanDesk> desk);

}  // namespace chorus::scan
