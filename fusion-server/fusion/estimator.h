// Interface of all fusion methods: turns the views of one person into one body, instant by instant.
//
// An estimator belongs to one person and may have memory; instants come in order of time.  Apart
// from its memory it is pure: the same views give the same bodies.
#pragma once

#include <memory>
#include <vector>

#include "fusion-server/flow/fused_body.h"
#include "fusion-server/flow/person.h"

namespace chorus::fusion {

struct Instant {
  Timestamp at;
  const std::vector<SensorId>& sensors;  ///< Bit i of FusedBody::contributors is sensors[i].
};

class Estimator {
 public:
  virtual ~Estimator() = default;
  /// A joint that nobody saw is NotTracked at position zero, unless the method predicts it.  The
  /// order of the views affects rounding only.
  [[nodiscard]] virtual FusedBody fuse(const Person& person, const Instant& instant) = 0;
  /// Another method has fused the person at this instant, fuse() is not called: learns of that body
  /// what is needed to go on from it.  Most methods learn nothing.
  virtual void attend(const FusedBody& /*body*/, const Person& /*person*/,
                      const Instant& /*instant*/) {}
  /// A copy, with everything it remembers.
  [[nodiscard]] virtual std::unique_ptr<Estimator> clone() const = 0;
};

}  // namespace chorus::fusion
