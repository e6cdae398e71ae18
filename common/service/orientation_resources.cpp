#include "common/service/orientation_resources.h"

#include <utility>

namespace chorus::service {
namespace {

http::DocumentPtr document_of_orientations(std::shared_ptr<const void> value,
                                           const resource::Place& place,
                                           http::DocumentOptions options) {
  return resource::orientations_document(
      std::static_pointer_cast<const resource::OrientationsResource>(std::move(value)), place,
      std::move(options));
}

// Nothing is interpolated: the document of an instant between two is the one before it.
constexpr ServedKind kServedOrientations{
    {"orientations", "orientations/", "document of orientations", nullptr},
    document_of_orientations};

}  // namespace

OrientationsPtr OrientationBatch::add(inertial::InertialFrame instant, Duration now) {
  readings_ += instant.readings.size();
  waiting_.push_back(std::move(instant));
  const bool due = !given_at_ || now - *given_at_ >= kInterval;
  const bool full = waiting_.size() >= resource::kMaxInstants || readings_ >= kMaxReadings;
  if (!due && !full) return nullptr;
  auto document = std::make_shared<resource::OrientationsResource>();
  document->sequence = ++given_;
  document->captured = waiting_.back().captured;
  document->source = waiting_.back().source.str();
  document->instants = std::exchange(waiting_, {});
  readings_ = 0;
  given_at_ = now;
  return document;
}

OrientationResources::OrientationResources(Serving serving, const DocumentHistory& history)
    : documents_(std::move(serving), history, kServedOrientations) {}

}  // namespace chorus::service
