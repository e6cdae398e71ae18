// What was published of a person's identity and turned out to be wrong.
#pragma once

#include "common/base/strong_id.h"
#include "common/time/timestamp.h"

namespace chorus {

/// From `since` to `until`, `person` was published under the id of somebody else.
struct Correction {
  PersonId published;
  PersonId person;
  Timestamp since;
  Timestamp until;

  bool operator==(const Correction&) const = default;
};

}  // namespace chorus
