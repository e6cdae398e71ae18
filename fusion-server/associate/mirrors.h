// Finds mirrors: planes in which one body is another one's image.
//
// A tracker that looks into a mirror, or at a glossy wall, sees everybody a second time behind it.
// Each joint of the image is the joint of the other side of the person, reflected in one plane,
//
//   image(j) = x - 2 (n . x - d) n,   x = person(mirror(j)),
//
// and it stays so while the person walks.  A second person is where a reflection would be for an
// instant, but not for a way of half a metre in the same plane; and sensors on both sides of that
// plane see them.  Once a plane is known, the next image in it is known at once.
#pragma once

#include <optional>
#include <vector>

#include "fusion-server/associate/gaze.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

/// How one body is the image of another one.
struct Reflection {
  Mirror mirror;
  double rms = 0.0;  ///< Distance of the joints from the person's reflected ones [m].
};

/// Whether the image's left is compared with the person's right, as in a mirror.  A tracker that
/// takes everybody for facing it has one of the two the other way round.
enum class Sides { Exchanged, Kept };

/// Collects joints of a person and of what may be their image, from one sensor or more.
class JointPairs {
 public:
  /// The bodies as one sensor sees them at one instant.
  void add(const Skeleton<WorldSpace>& person, const Skeleton<WorldSpace>& image, Sides sides);

  /// The plane in which the one is best the other's image; none if fewer than ten pairs of joints
  /// were given, or if the bodies are closer than 0.3 m.
  [[nodiscard]] std::optional<Reflection> reflection() const;
  /// Distance of the image's joints from the person's reflected in `mirror` [m, rms]; infinite
  /// without joints.
  [[nodiscard]] double distance(const Mirror& mirror) const;

 private:
  struct Pair {
    Eigen::Vector3d person, image;
  };
  std::vector<Pair> pairs_;
};

/// Where `place` appears in the mirror.
[[nodiscard]] Eigen::Vector3d reflected(const Mirror& mirror, const Eigen::Vector3d& place);

/// Takes the instant into every candidate's Track::image, and the mirrors that it shows into
/// `mirrors`.  Only sensors that see both bodies are asked.
void reflect(std::vector<Candidate>& candidates, const std::vector<Observer>& observers,
             double elapsed, Mirrors& mirrors);

}  // namespace chorus::associate
