// What a camera's place is good for: the error that it causes in an area.  Pure.
#pragma once

#include <string>
#include <vector>

#include "common/calibration/place.h"

namespace chorus::calibration {

struct Area {
  double across = 6.0;  ///< Along x, centred at the world's origin [m].
  double deep = 6.0;    ///< Along z [m].
};

/// The error at one point of the area.
struct PredictedError {
  Eigen::Vector3d point;
  double sigma = 0.0;  ///< Root mean square over all three axes [m].
  bool seen = true;    ///< False: behind the camera or outside its picture; `sigma` is 0.
};

/// How far a person who stands at this point, with the hips a metre above the floor, is misplaced
/// because the camera's pose and focal length are uncertain: what the camera sees keeps its pixel
/// and its distance.
[[nodiscard]] PredictedError error_at(const CameraPlace& place, const Intrinsics& lens,
                                      const Eigen::Vector3d& point);

/// At the four corners and the middle.
[[nodiscard]] std::vector<PredictedError> errors_in(const CameraPlace& place,
                                                    const Intrinsics& lens, const Area& area);

struct PlaceDemands {
  double error = 0.05;  ///< Largest at a corner that the camera sees [m].
};

/// One sentence for each weakness, saying what helps; empty if the place is good.
[[nodiscard]] std::vector<std::string> place_weaknesses(const std::vector<PredictedError>& errors,
                                                        const PlaceQuestion& question,
                                                        const PlaceDemands& demands = {});

}  // namespace chorus::calibration
