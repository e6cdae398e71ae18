// The trackd segments in System V shared memory: created at the start, and removed at exit unless a
// reader is still attached; then a restart takes them over.
//
// Readers attach with write access, so every program on this machine can write to the segments
// (0666): nothing is read back from them.  There is no lock; the header's time is written last.
#pragma once

#include <memory>

#include "common/base/config_reader.h"
#include "common/base/result.h"
#include "fusion-server/outlet/outlet.h"
#include "fusion-server/trackd/trackd_encoder.h"

namespace chorus::trackd {

struct Settings {
  int tracker_key = 4126;
  int controller_key = 4127;
  int sensors = 150;  ///< 25 per slot.
  LengthUnit unit = LengthUnit::Feet;

  bool operator==(const Settings&) const = default;
};

void read_settings(ConfigReader& reader, Settings& out);

/// Conflict when a segment with that key exists, unless an earlier run left it
/// (SharedSegment::create).
[[nodiscard]] Result<std::unique_ptr<outlet::Outlet>> open_outlet(
    const Settings& settings, const outlet::OutletContext& context);

}  // namespace chorus::trackd
