// Many views of one person -> one body.  One function, several methods behind it, all pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/units.h"
#include "fusion-server/flow.h"
#include "fusion-server/fusion/noise_model.h"

namespace chorus::fusion {

enum class Method {
  Otto,      ///< Weighted mean by Eqs. (1)-(3), orientation by LERP; all-zero: docs/decisions.
  Mean,      ///< Plain mean of the seen joints.
  BestView,  ///< The heaviest view alone; on a tie the one with more tracked joints.
  InverseVariance,  ///< Anisotropic inverse variance along and across the line of sight, robust.
};

[[nodiscard]] std::string_view name_of(Method method);
[[nodiscard]] std::optional<Method> method_named(std::string_view name);

struct FusionConfig {
  Method method = Method::InverseVariance;
  /// Otto weight of every view that saw a joint when all of their weights are zero (decision 0007);
  /// 0 leaves such a joint NotTracked.
  double zero_weight_floor = 0.02;
  NoiseModel noise;  ///< For sensors without an entry of their own.
  std::map<SensorId, NoiseModel> sensor_noise;
  double common_sigma = 0.0;  ///< Error all sensors share [m]; added to the stated variance.
  double huber = 1.5;         ///< In standard deviations; robust loss of InverseVariance.
};

/// Fuses each joint over the views that saw it.  A joint nobody saw is NotTracked with zero
/// position. Never divides by zero; permuting the views changes nothing but rounding.
[[nodiscard]] FusedBody fuse(const Person& person, const std::vector<SensorId>& sensors,
                             const FusionConfig& config);

}  // namespace chorus::fusion
