// A prop over time: what is learned while both hands are seen carries it on while one is not.
#pragma once

#include <optional>

#include "common/time/timestamp.h"
#include "common/workplace/prop.h"

namespace chorus::workplace {

class HeldProp {
 public:
  explicit HeldProp(Prop prop) : prop_(std::move(prop)) {}

  /// The prop at the next instant; none until its joints were seen.  While one of a pair is not
  /// well seen, the prop stays rigid on the other's limb.  When it is seen again, the difference is
  /// taken back within a few tenths of a second, so nothing jumps.
  [[nodiscard]] std::optional<PropPose> follow(Timestamp at, const Skeleton<WorldSpace>& body);

 private:
  /// The grip and the limb that carried it, when both of a pair were last seen.
  struct Grip {
    Eigen::Isometry3d world_from_grip;
    double sigma = 0.0;
    double turn_sigma = 0.0;
  };
  struct Limb {
    Eigen::Vector3d end;
    Eigen::Vector3d direction;
  };
  enum class By : std::uint8_t { Nothing, Both, First, Second };

  [[nodiscard]] By carried_by(const Skeleton<WorldSpace>& body) const;
  [[nodiscard]] std::optional<Grip> grip(By by, const Skeleton<WorldSpace>& body);
  [[nodiscard]] Skeleton<WorldSpace> kept_apart(Skeleton<WorldSpace> body);
  [[nodiscard]] std::optional<Limb> limb(JointId end, const Skeleton<WorldSpace>& body) const;
  /// Takes back a share of what is left over, and adds how far `carried` is from `grip`.
  void blend(Timestamp at, const std::optional<Grip>& carried, const Grip& grip);

  Prop prop_;
  By by_ = By::Nothing;
  std::optional<Grip> last_;
  std::array<std::optional<Limb>, 2> last_limbs_;
  double apart_ = 0.0;  ///< Mean distance of a pair of joints [m].
  double seen_ = 0.0;   ///< Instants that it is the mean of.
  Timestamp at_;
  Eigen::Vector3d left_over_ = Eigen::Vector3d::Zero();  ///< What is still to be taken back.
  Eigen::Vector3d left_turn_ = Eigen::Vector3d::Zero();  ///< As a rotation vector, in the world.
};

}  // namespace chorus::workplace
