// People in pictures, as pose estimators write them, and their identity from picture to picture.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace chorus::importers {

struct PosePoint {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double confidence = 0.0;  ///< In [0, 1]; 0: not found.
};

struct PosePerson {
  std::vector<PosePoint> points;         ///< In the order of a layout.
  std::optional<std::uint64_t> id = {};  ///< The id in the file plus 1, if the file states one.
};

/// Numbers people consistently where a file numbers them from scratch in every picture: each gets
/// the number of the nearest person of the recent pictures, if the two are no farther apart than
/// half the size (Known::size) of the larger one.
class PeopleNumbers {
 public:
  /// A different number for each; the file's ids, if all people have different ones.
  [[nodiscard]] std::vector<std::uint64_t> number(const std::vector<PosePerson>& people);

 private:
  struct Known {
    std::uint64_t number = 0;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double size = 0.0;  ///< Diagonal of the box around the points [px].
    int missed = 0;     ///< Number of pictures since the person was last seen.
  };
  /// A person of this picture and one of earlier pictures who may be the same.
  struct Pair {
    double distance = 0.0;  ///< [px]
    std::size_t person = 0;
    std::size_t known = 0;
  };
  /// The possible pairs, nearest first.
  [[nodiscard]] std::vector<Pair> pairs(const std::vector<PosePerson>& people) const;
  void follow(const std::vector<PosePerson>& people, std::vector<std::uint64_t>& numbers);

  std::vector<Known> known_;
  std::uint64_t last_ = 0;
};

}  // namespace chorus::importers
