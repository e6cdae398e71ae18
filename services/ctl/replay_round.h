// How the streams of a recording stay in step while each is played by a process of its own.
#pragma once

#include <optional>

#include "common/record/session_reader.h"

namespace chorus::ctl {

/// Where a set begins and how long one round of it lasts.
struct Round {
  Timestamp origin;
  Duration period{0};

  bool operator==(const Round&) const = default;
};

/// None for one stream alone, for recordings that all note their set themselves (importers do), and
/// for recordings of different times, which have no beginning in common.
[[nodiscard]] std::optional<Round> round_of(const record::Session& session);

/// Several streams, and no instant at which all of them were being recorded.
[[nodiscard]] bool of_different_times(const record::Session& session);

}  // namespace chorus::ctl
