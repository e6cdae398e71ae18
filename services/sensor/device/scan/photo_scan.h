// The scan of a photo that a page sent, with the runner's network if there is one.
#pragma once

#include "services/sensor/device/scan/scan_desk.h"

namespace chorus::scan {

/// Starts the network with the first photo, and keeps it; without it the outline alone answers, and
/// the report says so.  The function is for one thread.
[[nodiscard]] ScanPhoto photo_scan();

}  // namespace chorus::scan
