#include "common/client/orientations.h"

#include <utility>

#include "common/client/frames.h"

namespace chorus::client {
namespace {

Result<Document> read_orientations_document(std::string_view text, resource::Format format,
                                            const SensorId& expected) {
  auto read = resource::read_orientations(text, format);
  if (!read) return pass(read);
  if (read->source != expected.str()) return not_called("orientations", read->source, expected);
  return resource::document_of_value(
      std::make_shared<const resource::OrientationsResource>(std::move(*read)));
}

}  // namespace

const KindOf<resource::OrientationsResource> kOrientations{
    {"orientations", "orientations/", false, resource::Format::Json, read_orientations_document}};

std::vector<inertial::InertialFrame> place_in_time(
    const Arrived<resource::OrientationsResource>& arrived) {
  const Duration by = correction(arrived.clock);
  std::vector<inertial::InertialFrame> instants = arrived.document->instants;
  for (inertial::InertialFrame& instant : instants) {
    instant.source = arrived.source;
    instant.received = arrived.received;
    instant.captured += by;
    for (inertial::InertialReading& each : instant.readings) each.captured += by;
  }
  return instants;
}

}  // namespace chorus::client
