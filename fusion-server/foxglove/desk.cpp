#include "fusion-server/foxglove/desk.h"

#include <utility>

#include "common/record/frame_schema.h"
#include "common/record/skeleton_scene.h"
#include "fusion-server/wire/registration_file.h"
#include "fusion-server/wire/snapshot_resource.h"

namespace chorus::foxglove {
namespace {

std::string frame_json(const resource::FrameResource& frame) {
  return resource::write(frame, resource::Format::Json);
}

}  // namespace

Desk::Desk() {
  for (const auto& [topic, schema] : {std::pair{"/frame", record::kFrameSchemaName},
                                      {"/scene", record::kSceneSchemaName},
                                      {"/registration", record::kRegistrationSchemaName},
                                      {"/transforms", record::kTransformsSchemaName}})
    put(topic, schema, {}, nullptr);
}

/// Without `make` the channel is only made known.
void Desk::put(const std::string& topic, std::string_view schema, Timestamp at,
               std::function<std::string()> make) {
  const auto message = make ? std::make_shared<const Message>(at, std::move(make)) : nullptr;
  const std::scoped_lock lock(mutex_);
  const auto [place, is_new] = index_.try_emplace(topic, channels_.size());
  if (is_new) {
    const auto id = static_cast<std::uint32_t>(channels_.size() + 1);
    channels_.push_back({id, topic, std::string(schema)});
  }
  if (!message) return;
  channels_[place->second].newest = message;
  ++channels_[place->second].version;
}

void Desk::publish(std::shared_ptr<const Snapshot> snapshot) {
  const Timestamp at = snapshot->instant;
  put("/frame", record::kFrameSchemaName, at,
      [snapshot] { return frame_json(wire::to_resource(*snapshot)); });
  put("/scene", record::kSceneSchemaName, at, [snapshot] {
    return record::scene_update(wire::to_resource(*snapshot), record::kWorldFrame);
  });
  wake_->publish(nullptr);
}

void Desk::raw(const SensorId& sensor, const resource::FramePtr& frame, Timestamp received) {
  const std::string prefix = "/sensors/" + sensor.str();
  put(prefix + "/frame", record::kFrameSchemaName, received,
      [frame] { return frame_json(*frame); });
  put(prefix + "/scene", record::kSceneSchemaName, received,
      [frame, sensor] { return record::scene_update(*frame, sensor.str()); });
}

void Desk::places(const Registration& registration, Timestamp now) {
  {
    const std::scoped_lock lock(mutex_);
    const bool told = channels_[index_.at("/transforms")].newest != nullptr;
    if (told && registration.version == places_version_) return;
    places_version_ = registration.version;
  }
  const auto changed =
      std::make_shared<const record::PlacesChanged>(wire::places_changed(now, registration));
  put("/registration", record::kRegistrationSchemaName, now,
      [changed] { return changed->registration; });
  put("/transforms", record::kTransformsSchemaName, now,
      [changed] { return record::frame_transforms(changed->at, changed->places); });
}

std::vector<Channel> Desk::channels() const { return channels_after(0); }

std::vector<Channel> Desk::channels_after(std::uint32_t id) const {
  const std::scoped_lock lock(mutex_);
  if (id >= channels_.size()) return {};
  return {channels_.begin() + id, channels_.end()};
}

Channel Desk::channel(std::uint32_t id) const {
  const std::scoped_lock lock(mutex_);
  return id >= 1 && id <= channels_.size() ? channels_[id - 1] : Channel{};
}

}  // namespace chorus::foxglove
