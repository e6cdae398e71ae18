// Following /orientations: what the worn inertial sensors of one source say.
#pragma once

#include "common/client/document_kind.h"
#include "common/resource/orientations_resource.h"

namespace chorus::client {

/// Asked for in JSON; the document must be of the expected source.
extern const KindOf<resource::OrientationsResource> kOrientations;

/// The instants with their times corrected to our clock.
[[nodiscard]] std::vector<inertial::InertialFrame> place_in_time(
    const Arrived<resource::OrientationsResource>& arrived);

}  // namespace chorus::client
