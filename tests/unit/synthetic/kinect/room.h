// One person walking in front of a sensor, for tests of the whole sensor model.
#pragma once

#include "common/synthetic/kinect/error_source.h"
#include "common/synthetic/kinect/kinect_sensor.h"

namespace chorus::synthetic::kinect {

inline constexpr Timestamp kStart = from_unix_ns(1'795'000'000'000'000'000);

inline constexpr std::array kAllSources{Source::Visibility, Source::Yaw,   Source::Bias,
                                        Source::Coloured,   Source::White, Source::Gross,
                                        Source::Delivery,   Source::Clock};

inline Scene room(std::size_t people = 1) {
  WalkerScript script;
  script.centre = {0.0, 2.6};
  script.reach = 0.9;
  Scene scene;
  scene.people = make_people(script, people);
  scene.world_from_sensor = {stand_sensor({0, 1.2, 0}, 0.0, deg(5)),
                             stand_sensor({1.5, 1.2, 0.3}, -deg(30), deg(5))};
  return scene;
}

inline KinectSetting setting(Profile profile, std::uint64_t seed = 1, std::size_t place = 0) {
  return {*SensorId::parse("s1"), place, std::move(profile), seed, 1, true};
}

inline Profile perfect() {
  Profile profile = nominal_profile("A");
  for (const Source source : kAllSources) profile = with_source(std::move(profile), source, 0.0);
  return profile;
}

}  // namespace chorus::synthetic::kinect
