#include "fusion-server/fusion/learned_errors.h"

#include <utility>

namespace chorus::fusion {
namespace {

class LearnedErrors final : public ErrorModel {
 public:
  explicit LearnedErrors(const FusionConfig& config)
      : all_(config.errors),
        of_sensors_(config.sensor_errors),
        otherwise_(line_of_sight_errors(config.noise, config.sensor_noise)) {}

  [[nodiscard]] JointError error(const SensorView& view, JointId id) const override {
    JointError found = otherwise_->error(view, id);
    const Joint& joint = view.skeleton[id];
    const ErrorPredictor* predictor = predictor_of(view.sensor);
    if (predictor == nullptr || found.whole || !joint.seen()) return found;
    const auto predicted = predicted_error(*predictor, id, features_of(view, id));
    if (!predicted) return found;
    const double rms = predictor->joints[index_of(id)]->rms * *predicted;
    return {found.covariance * (rms * rms / found.covariance.trace()), true};
  }

 private:
  [[nodiscard]] const ErrorPredictor* predictor_of(const SensorId& sensor) const {
    const auto own = of_sensors_.find(sensor);
    return (own == of_sensors_.end() ? all_ : own->second).model.get();
  }

  SharedPredictor all_;
  std::map<SensorId, SharedPredictor> of_sensors_;
  std::shared_ptr<const ErrorModel> otherwise_;
};

}  // namespace

std::unique_ptr<const ErrorModel> errors_of(const FusionConfig& config) {
  if (!config.errors.model && config.sensor_errors.empty())
    return line_of_sight_errors(config.noise, config.sensor_noise);
  return std::make_unique<LearnedErrors>(config);
}

}  // namespace chorus::fusion
