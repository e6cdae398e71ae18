#include "common/synthetic/sensor_choice.h"

#include "common/synthetic/kinect/kinect_sensor.h"

namespace chorus::synthetic {
namespace {

bool is_drawn(std::string_view profile) { return profile == "A" || profile == "B"; }

kinect::Profile parameters(const SensorChoice& choice) {
  kinect::Profile profile = choice.draw ? kinect::draw_profile(choice.profile, *choice.draw)
                                        : kinect::nominal_profile(choice.profile);
  for (const Stress& stress : choice.stress) {
    profile = with_source(std::move(profile), stress.source, stress.factor);
  }
  return profile;
}

}  // namespace

bool has_source(std::string_view profile, Source source) {
  return is_drawn(profile) ||
         (source != Source::Yaw && source != Source::Coloured && source != Source::Visibility);
}

Result<std::unique_ptr<BodySensor>> make_sensor(const Scene& scene, const SensorChoice& choice,
                                                Timestamp start) {
  if (choice.place >= scene.world_from_sensor.size())
    return fail(ErrorCode::InvalidArgument, choice.id.str(), "the scene has no such place");
  if (!is_drawn(choice.profile))
    return fail(ErrorCode::InvalidArgument, choice.profile, "the sensor profiles are A and B");
  return std::make_unique<kinect::KinectSensor>(
      scene,
      kinect::KinectSetting{choice.id, choice.place, parameters(choice), choice.seed,
                            choice.bias_seed, choice.own_clock},
      start);
}

Result<std::vector<SensorFrame>> record(const Scene& scene, const SensorChoice& choice,
                                        Timestamp start, Timestamp end) {
  const auto sensor = make_sensor(scene, choice, start);
  if (!sensor) return pass(sensor);
  return record(**sensor, end);
}

std::string frozen_hash(std::string_view profile) {
  return is_drawn(profile) ? kinect::frozen_hash() : std::string();
}

}  // namespace chorus::synthetic
