// True bodies over time, from fused frames that are taken as the truth: which one a seen person is,
// and where its joints are at an instant.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/exporters/take.h"
#include "fusion-server/flow/person.h"

namespace chorus::ctl {

class TrueBodies {
 public:
  explicit TrueBodies(std::vector<exporters::FusedSample> samples);

  /// The body at the person's place: the centre-axis joints of the person's views are within 0.5 m
  /// of its own, horizontally.  Interpolated between samples that are at most 0.1 s apart; none if
  /// there is no such body.
  [[nodiscard]] std::optional<Skeleton<WorldSpace>> at(Timestamp instant,
                                                       const Person& person) const;

 private:
  std::map<PersonId, std::vector<exporters::FusedSample>> tracks_;  ///< In order of time.
};

}  // namespace chorus::ctl
