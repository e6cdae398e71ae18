#include "common/synthetic/sensor_choice.h"

#include "common/synthetic/depth/depth_sensor.h"
#include "common/synthetic/gauss_sensor.h"
#include "common/synthetic/kinect/kinect_sensor.h"

namespace chorus::synthetic {
namespace {

bool is_rendered(std::string_view profile) { return profile == "C"; }

template <class Profile>
Profile stressed(Profile profile, const std::vector<Stress>& all) {
  for (const Stress& stress : all) {
    profile = with_source(std::move(profile), stress.source, stress.factor);
  }
  return profile;
}

std::unique_ptr<BodySensor> drawn_sensor(const Scene& scene, const SensorChoice& choice,
                                         Timestamp start) {
  const kinect::Profile profile = choice.draw ? kinect::draw_profile(choice.profile, *choice.draw)
                                              : kinect::nominal_profile(choice.profile);
  return std::make_unique<kinect::KinectSensor>(
      scene,
      kinect::KinectSetting{choice.id, choice.place, stressed(profile, choice.stress), choice.seed,
                            choice.bias_seed, choice.own_clock},
      start);
}

std::unique_ptr<BodySensor> rendered_sensor(const Scene& scene, const SensorChoice& choice,
                                            Timestamp start) {
  const depth::DepthProfile profile =
      choice.draw ? depth::draw_depth_profile(*choice.draw) : depth::nominal_depth_profile();
  return std::make_unique<depth::DepthSensor>(
      scene,
      depth::DepthSetting{choice.id, choice.place, stressed(profile, choice.stress), choice.seed,
                          choice.bias_seed, choice.own_clock},
      start);
}

}  // namespace

bool is_drawn(std::string_view profile) {
  return profile == "A" || profile == "B" || profile == "D";
}

Result<std::unique_ptr<BodySensor>> make_sensor(const Scene& scene, const SensorChoice& choice,
                                                Timestamp start) {
  if (choice.place >= scene.world_from_sensor.size())
    return fail(ErrorCode::InvalidArgument, choice.id.str(), "the scene has no such place");
  if (is_drawn(choice.profile)) return drawn_sensor(scene, choice, start);
  if (is_rendered(choice.profile)) return rendered_sensor(scene, choice, start);
  if (choice.profile == kGaussProfile) {
    return std::make_unique<GaussSensor>(
        scene, SimulatedSensor{choice.id, choice.place, choice.gauss}, start);
  }
  return fail(ErrorCode::InvalidArgument, choice.profile,
              "the sensor profiles are A, B, C, D and gauss");
}

Result<std::vector<SensorFrame>> record(const Scene& scene, const SensorChoice& choice,
                                        Timestamp start, Timestamp end) {
  const auto sensor = make_sensor(scene, choice, start);
  if (!sensor) return pass(sensor);
  return record(**sensor, end);
}

std::string frozen_hash(std::string_view profile) {
  if (is_drawn(profile)) return kinect::frozen_hash();
  return is_rendered(profile) ? depth::frozen_depth_hash() : std::string();
}

}  // namespace chorus::synthetic
