// People in pictures, as pose estimators write them, and the same person from picture to picture.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace chorus::importers {

struct PosePoint {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double confidence = 0.0;  ///< 0: not found; at most 1.
};

struct PosePerson {
  std::vector<PosePoint> points;         ///< In the order of a layout.
  std::optional<std::uint64_t> id = {};  ///< As the file says, if it does.
};

/// Numbers people who are numbered anew in every picture: each keeps the number of the nearest
/// person of the pictures before, if that is within half of their height.
class PeopleNumbers {
 public:
  /// One number for each, none twice; the ids of the file, where all have one.
  [[nodiscard]] std::vector<std::uint64_t> number(const std::vector<PosePerson>& people);

 private:
  struct Known {
    std::uint64_t number = 0;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double size = 0.0;  ///< Diagonal of the box around the points [px].
    int missed = 0;     ///< Pictures since.
  };
  /// A person of this picture who may be one of those before.
  struct Pair {
    double distance = 0.0;  ///< [px]
    std::size_t person = 0;
    std::size_t known = 0;
  };
  /// Nearest first.
  [[nodiscard]] std::vector<Pair> pairs(const std::vector<PosePerson>& people) const;
  void follow(const std::vector<PosePerson>& people, std::vector<std::uint64_t>& numbers);

  std::vector<Known> known_;
  std::uint64_t last_ = 0;
};

}  // namespace chorus::importers
