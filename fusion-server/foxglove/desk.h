// The channels that viewers can subscribe to, with the newest message of each: those of recordings
// (common/record/cell_writer.h), live.
//
//   /frame, /scene                           fused
//   /sensors/{id}/frame, /sensors/{id}/scene  as the sensor sent them
//   /registration, /transforms               where the sensors stand
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/http/live_document.h"
#include "common/resource/frame_document.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/foxglove/channel.h"
#include "fusion-server/sink.h"

namespace chorus::foxglove {

/// Thread-safe.  Messages are written only when somebody is subscribed to them.
class Desk final : public Sink {
 public:
  Desk();

  [[nodiscard]] std::string_view name() const override { return "foxglove"; }
  void publish(std::shared_ptr<const Snapshot> snapshot) override;
  void raw(const SensorId& sensor, const resource::FramePtr& frame, Timestamp received);
  /// Tells the places if they have changed.
  void places(const Registration& registration, Timestamp now);

  /// All channels, by id from 1 without gaps.
  [[nodiscard]] std::vector<Channel> channels() const;
  /// Those with ids greater than `id`.
  [[nodiscard]] std::vector<Channel> channels_after(std::uint32_t id) const;
  /// The channel as it is now; id 0 if there is none.
  [[nodiscard]] Channel channel(std::uint32_t id) const;

  /// Is published with every fused frame, to wake the dialogues.
  [[nodiscard]] const std::shared_ptr<http::LiveDocument>& wake() const { return wake_; }

 private:
  void put(const std::string& topic, std::string_view schema, Timestamp at,
           std::function<std::string()> make);

  std::shared_ptr<http::LiveDocument> wake_ = std::make_shared<http::LiveDocument>();
  mutable std::mutex mutex_;  ///< Guards the members below.
  std::vector<Channel> channels_;
  std::map<std::string, std::size_t> index_;  ///< Of channels_, by topic.
  std::uint64_t places_version_ = 0;
};

}  // namespace chorus::foxglove
