#include "common/synthetic/depth/depth_profile.h"

#include <algorithm>
#include <array>

#include "common/synthetic/draw.h"
#include "sources_hash.h"

namespace chorus::synthetic::depth {
namespace {

constexpr std::uint64_t kPurpose = 1101;
// Limit of the shares of pixels, so that something is still seen.
constexpr double kMostLost = 0.9;

struct Parameter {
  double& (*field)(DepthProfile&);
  double value;
  double spread;  ///< The parameter is drawn uniformly from value * (1 +- spread).
};

// Sources: [notes] simulator notes 6.1, layer 10; [spec] Kinect v2; [ansur] standard deviations of
// body girths, 6068 people, ANSUR II (Gordon et al. 2014); [est] an estimate of ours, varied in the
// stress sweeps.
constexpr std::array kParameters{
    // [notes] sigma(z) = 1.2 mm + 0.4 mm (z / 1 m)^2
    Parameter{[](DepthProfile& p) -> double& { return p.camera.noise_near; }, 0.0012, 0.3},
    Parameter{[](DepthProfile& p) -> double& { return p.camera.noise_square; }, 0.0004, 0.3},
    // [est] mixed depths occur on about one of the 512 columns; our pixels are four columns wide
    Parameter{[](DepthProfile& p) -> double& { return p.camera.flying_share; }, 0.2, 0.4},
    // [est]
    Parameter{[](DepthProfile& p) -> double& { return p.camera.hole_share; }, 0.003, 0.5},
    Parameter{[](DepthProfile& p) -> double& { return p.camera.dark_hole_share; }, 0.3, 0.5},
    // [spec]
    Parameter{[](DepthProfile& p) -> double& { return p.camera.least_range; }, 0.5, 0.0},
    Parameter{[](DepthProfile& p) -> double& { return p.camera.most_range; }, 4.5, 0.0},
    // [ansur] standard deviations are 6-10 % of the girths: uniform +-15 % has 8.7 %
    Parameter{[](DepthProfile& p) -> double& { return p.build.girth; }, 0.15, 0.0},
    // [est]
    Parameter{[](DepthProfile& p) -> double& { return p.build.clothing; }, 0.012, 0.5},
    Parameter{[](DepthProfile& p) -> double& { return p.build.dark_chance; }, 0.25, 0.5},
};

template <class Scale>
DepthProfile filled(const kinect::Profile& kinect, Scale scale) {
  DepthProfile profile;
  profile.delivery = kinect.delivery;
  profile.clock = kinect.clock;
  for (const Parameter& each : kParameters) each.field(profile) = each.value * scale(each.spread);
  return profile;
}

void scale(double& share, double factor) { share = std::clamp(share * factor, 0.0, kMostLost); }

}  // namespace

DepthProfile nominal_depth_profile() {
  return filled(kinect::nominal_profile("A"), [](double) { return 1.0; });
}

DepthProfile draw_depth_profile(std::uint64_t seed) {
  Draw draw{seed, kPurpose};
  return filled(kinect::draw_profile("A", seed),
                [&draw](double spread) { return 1.0 + draw.uniform(-spread, spread); });
}

DepthProfile with_source(DepthProfile profile, kinect::Source source, double factor) {
  using kinect::Source;
  factor = std::max(0.0, factor);
  if (source == Source::White) {
    profile.camera.noise_near *= factor;
    profile.camera.noise_square *= factor;
  } else if (source == Source::Gross) {
    scale(profile.camera.flying_share, factor);
    scale(profile.camera.hole_share, factor);
    scale(profile.camera.dark_hole_share, factor);
  } else if (source == Source::Bias) {
    scale(profile.build.girth, factor);
    profile.build.clothing *= factor;
  } else {
    kinect::Profile shared;
    shared.delivery = profile.delivery;
    shared.clock = profile.clock;
    shared = kinect::with_source(std::move(shared), source, factor);
    profile.delivery = shared.delivery;
    profile.clock = shared.clock;
  }
  return profile;
}

std::string frozen_depth_hash() { return kSourcesHash; }

}  // namespace chorus::synthetic::depth
