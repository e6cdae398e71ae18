// How good the fused bodies of a recording are, from the bodies alone: coverage, gaps, jitter,
// jumps, bone lengths, sides, people.
//
// Shapes: frames in world space, in order of time.  Lengths in metres, times in seconds.  Nothing
// here knows the truth; each figure says what it can and cannot show (quality_report.h).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/body/bones.h"
#include "common/resource/frame_resource.h"

namespace chorus::quality {

/// One joint of all people together.  Shares are of the instants in which its person is present.
struct JointQuality {
  double tracked = 0.0;
  double inferred = 0.0;
  double missing = 0.0;
  double unseen = 0.0;   ///< Tracked or inferred, but no sensor contributes: it is predicted.
  double carried = 0.0;  ///< The person is out of sight; the joint is where it is expected.
  int gaps = 0;          ///< Times at which it became missing.
  double longest_gap = 0.0;
  double longest_gap_at = 0.0;  ///< After the first frame.
  double sensors = 0.0;         ///< Mean number of sensors that contribute, while it is tracked.
  /// Standard deviation of the noise per axis, from second differences while it moves by less than
  /// 0.1 m/s (third differences while it moves faster).  NaN: never so.
  double jitter_at_rest = 0.0;
  double jitter_in_motion = 0.0;
  double first_jump_at = 0.0;  ///< After the first frame [s].
  int jumps = 0;               ///< Steps that no body makes: more than 0.1 m off uniform motion.
  double stated = 0.0;  ///< Root mean square of the stated standard deviation per axis.  NaN: none.
};

/// One bone of one person: mean length, and its standard deviation relative to it.
struct BoneQuality {
  double length = 0.0;
  double variation = 0.0;
};

/// A moment that somebody should look at.
struct Moment {
  double at = 0.0;  ///< After the first frame.
  std::uint64_t person = 0;
  std::string what;
};

struct PersonQuality {
  std::uint64_t id = 0;
  double from = 0.0;  ///< After the first frame.
  double to = 0.0;
  double seconds = 0.0;              ///< Present.
  double least_certain_sides = 1.0;  ///< Smallest stated probability.
  double uncertain_sides = 0.0;      ///< Share of time below 0.9.
  std::array<BoneQuality, kBones.size()> bones{};
};

struct FusedQuality {
  std::size_t frames = 0;
  double seconds = 0.0;
  double rate = 0.0;  ///< Frames per second, by the median step.
  int pauses = 0;     ///< Steps longer than three usual ones.
  double longest_pause = 0.0;
  double with_people = 0.0;  ///< Share of frames with somebody.
  std::array<JointQuality, kJointCount> joints{};
  std::vector<PersonQuality> people;  ///< In the order of their first frames.
  std::vector<Moment> switches;       ///< An id ended and another one began at the same place.
  std::vector<Moment> doubles;        ///< Two bodies in one place for more than half a second.
  std::vector<Moment> turned;         ///< Left and right were exchanged from one frame to the next.
  std::map<std::string, double> shares;  ///< Of each sensor in the joints' contributors.
};

/// Takes frame by frame, so that an hour needs no more memory than a second.
class FusedJudge {
 public:
  FusedJudge();
  ~FusedJudge();
  FusedJudge(FusedJudge&&) noexcept;

  /// Frames that do not follow the one before in time are left out.
  void add(const resource::FrameResource& frame);
  [[nodiscard]] FusedQuality finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::quality
