// `/orientations`: what the worn inertial sensors of one source said, as one document.
//
// Sensors sample up to a thousand times a second, clients are served fifty documents a second at
// most (service/orientation_batch.h), so a document holds the instants since the one before it.
// Units and axes as in inertial/inertial_frame.h; specified in proto/README.md.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/inertial/inertial_frame.h"
#include "common/resource/document.h"
#include "common/resource/node.h"

namespace chorus::resource {

struct OrientationsResource {
  std::uint64_t sequence = 0;  ///< Counts the documents.
  Timestamp captured;          ///< Of the newest instant.
  std::string source;          ///< Sensor id.
  /// In order of time; each with its own sequence, and with `source` as above.  At least one, at
  /// most kMaxInstants.
  std::vector<inertial::InertialFrame> instants;
};

inline constexpr std::size_t kMaxInstants = 100;

/// Readings are keyed by the sensor's name.  Orientations have six decimals (2e-6 rad),
/// accelerations and rates five.
[[nodiscard]] Node orientations_node(const OrientationsResource& orientations);

[[nodiscard]] std::string write(const OrientationsResource& orientations, Format format,
                                const Place& place = {});

/// The document of `/orientations` or of one of `/orientations/{seq}`, in all formats, each
/// rendered when the first client asks for it.
[[nodiscard]] http::DocumentPtr orientations_document(
    std::shared_ptr<const OrientationsResource> orientations, const Place& place,
    http::DocumentOptions options);

/// Reads JSON or JSON-LD in the form of orientations_node(); `received` of the instants is not on
/// the wire.  Unknown members are ignored.  Refuses what inertial::checked() refuses, half a
/// quaternion, vector or covariance, limbs and magnetic states that do not exist, instants out of
/// order, and times before 1970; errors name the sensor and the property.  Unsupported in Turtle
/// and N-Triples: ask for application/json.
[[nodiscard]] Result<OrientationsResource> read_orientations(std::string_view bytes, Format format);

}  // namespace chorus::resource
