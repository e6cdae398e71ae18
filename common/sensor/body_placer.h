// Places the people of one camera whose model states, in addition to their landmarks, their shapes
// in metres.
#pragma once

#include <map>
#include <span>

#include "common/body/body_frame.h"
#include "common/sensor/body_placing.h"
#include "common/sensor/learned_bones.h"

namespace chorus {

/// Keeps the bone lengths of each person.  Not thread-safe.
class BodyPlacer {
 public:
  /// Turns the rays of each body into points if they fit the body's shape (body_placing.h); other
  /// bodies stay as they are.  `shapes` is as long as `bodies`; a shape without joints means that
  /// none is known.
  void place(std::span<BodyFrame> bodies, std::span<const Skeleton<SensorSpace>> shapes,
             const PlacingErrors& errors);
  /// Number of people who are remembered.
  [[nodiscard]] std::size_t remembered() const { return people_.size(); }

 private:
  struct Person {
    LearnedBones bones;
    std::uint64_t last = 0;  ///< Frame in which the person was last seen.
  };
  void forget();

  std::map<BodyId, Person> people_;
  std::uint64_t frame_ = 0;
};

}  // namespace chorus
