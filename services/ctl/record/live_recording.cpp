#include "services/ctl/record/live_recording.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/json.h"
#include "common/client/service_client.h"
#include "common/record/frame_recording.h"
#include "common/resource/floor_plane_resource.h"
#include "common/resource/orientations_resource.h"
#include "fusion-server/wire/registration_file.h"
#include "services/ctl/record/recorded_clock.h"

namespace chorus::ctl {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kClocksEvery{500};
constexpr milliseconds kFloorEvery{10'000};
constexpr auto kFileWithin = std::chrono::seconds(30);

bool is_a(const nlohmann::json& self, const std::string& type) {
  const auto found = self.is_object() ? self.find("@type") : self.end();
  if (!self.is_object() || found == self.end()) return false;
  return found->is_array() ? std::find(found->begin(), found->end(), type) != found->end()
                           : *found == type;
}

/// Whether a sensor has this resource: one with worn sensors alone has no /frame.
bool has_resource(const nlohmann::json& self, const char* key) {
  return self.contains(key) || (std::string_view(key) == "frame" && !self.contains("orientations"));
}

Timestamp received(const http::ClientResponse& answer) { return from_unix_ns(answer.received_ns); }

record::CellHead head_of(const nlohmann::json& self, bool tracker) {
  record::CellHead head;
  head.metadata["title"] = client::text_at(self, "title", "");
  head.single_sensor = !tracker;
  if (tracker) return head;
  record::FrameRecording about;
  if (const auto id = SensorId::parse(client::text_at(self, "sensorId", ""))) about.sensor = *id;
  about.device = client::text_at(self, "deviceLabel", "");
  head.metadata.merge(record::metadata_of(about));
  return head;
}

Result<void> in_a_hall(const client::ServiceClient& server, bool tracker, const std::string& url) {
  if (!tracker)
    return fail(ErrorCode::Unsupported, url, "is no fusion server, so it is in no hall");
  const auto cells = server.get("/site/cells/");
  if (!cells && cells.error().code == ErrorCode::NotFound)
    return fail(ErrorCode::NotFound, url, "belongs to no site: record without --site");
  return {};
}

}  // namespace

Result<std::unique_ptr<LiveRecording>> LiveRecording::start(asio::io_context& io,
                                                            LiveRecordingOptions options) {
  const std::string url = http::url_text(options.service, options.service.target);
  auto trust = client::authorities();
  if (!trust) return pass(trust);
  const auto server = client::ServiceClient::of(url);
  if (!server) return pass(server);
  const auto self = server->get("/");
  if (!self) return pass(self);
  const bool tracker = is_a(*self, "Tracker");
  const auto id = SensorId::parse(client::text_at(*self, "sensorId", ""));
  if (!tracker && !(is_a(*self, "Sensor") && id)) {
    return fail(ErrorCode::Unsupported, url, "is neither a sensor nor a fusion server");
  }
  Result<nlohmann::json> sensors = nlohmann::json();
  if (options.site)
    if (const auto ok = in_a_hall(*server, tracker, url); !ok) return pass(ok);
  if (tracker && !(sensors = server->get("/sensors/"))) return pass(sensors);
  // A tracker of an earlier version has no inertial sources.
  const auto inertial = tracker ? server->get("/inertial/") : Result<nlohmann::json>();

  record::RecorderOptions recording;
  recording.name = "recording";
  recording.file = options.file;
  recording.head = head_of(*self, tracker);
  recording.limits.min_free_bytes = 0;  // The file belongs to the user, who may fill the disk.
  auto recorder = record::Recorder::start(std::move(recording));
  if (!recorder) return pass(recorder);
  std::unique_ptr<LiveRecording> live(new LiveRecording(io, std::move(options), std::move(*trust)));
  live->recorder_ = std::move(*recorder);
  if (tracker) {
    live->poll_tracker(client::part_at(*sensors, "sensors"));
    live->poll_suits(inertial.value_or(nlohmann::json()));
  } else {
    if (has_resource(*self, "frame")) live->poll_raw(*id, "/");
    if (has_resource(*self, "orientations")) live->poll_suit(*id, "/orientations");
  }
  for (client::LivePoll& one : live->polls_) one.start();
  return live;
}

void LiveRecording::poll_frames(const std::string& topic, Take take, const std::string& accept) {
  client::StreamCount& count = counts_[topic];
  polls_.emplace_back(io_, options_.service,
                      client::LivePoll::Options{.target = topic, .accept = accept, .trust = trust_},
                      client::LivePoll::Takers{std::move(take), [&count](const Error& error, int) {
                                                 count.fail(error);
                                               }});
}

void LiveRecording::poll_state(client::LivePoll::Options what, Take take) {
  const std::string path = what.target;
  what.trust = trust_;
  polls_.emplace_back(io_, options_.service, std::move(what),
                      client::LivePoll::Takers{
                          [this, path, take = std::move(take)](const http::ClientResponse& answer) {
                            troubles_.erase(path);
                            take(answer);
                          },
                          [this, path](const Error& error, int) {
                            // It is not an error that a service lacks a resource, such as a floor.
                            if (error.code != ErrorCode::NotFound)
                              troubles_[path] = to_string(error);
                          }});
}

void LiveRecording::poll_raw(const SensorId& sensor, const std::string& prefix) {
  poll_state({prefix + "floor-plane", "application/json", kFloorEvery},
             [this, sensor, prefix](const http::ClientResponse& answer) {
               const auto floor = resource::read_floor_plane(answer.body, resource::Format::Json);
               if (floor) floors_[sensor] = *floor;
               if (!floor) troubles_[prefix + "floor-plane"] = to_string(floor.error());
             });
  poll_frames(prefix + "frame",
              [this, sensor, topic = prefix + "frame"](const http::ClientResponse& answer) {
                take_raw(sensor, topic, answer);
              });
}

void LiveRecording::poll_tracker(const nlohmann::json& sensors) {
  // Where the sensors of one cell stand says nothing of a hall.
  if (!options_.site)
    poll_state({"/registration", "application/json"},
               [this](const http::ClientResponse& answer) { take_registration(answer); });
  if (options_.raw) {
    poll_state({"/sensors/", "application/json", kClocksEvery},
               [this](const http::ClientResponse& answer) { take_clocks(answer); });
    for (const auto& [name, sensor] : sensors.items()) {
      if (const auto id = SensorId::parse(name)) {
        clocks_[*id] = clock_of(sensor);
        poll_raw(*id, "/sensors/" + name + "/");
      }
    }
  }
  if (options_.fused) {
    poll_frames(fused_topic(), [this](const http::ClientResponse& answer) { take_fused(answer); });
  }
}

void LiveRecording::poll_suit(const SensorId& source, const std::string& topic) {
  poll_frames(
      topic,
      [this, source, topic](const http::ClientResponse& answer) {
        take_suit(source, topic, answer);
      },
      "application/json");
}

void LiveRecording::poll_suits(const nlohmann::json& listed) {
  const nlohmann::json& sources = client::part_at(listed, "inertialSources");
  if (!options_.raw || sources.empty()) return;
  poll_state({"/inertial/", "application/json", kClocksEvery},
             [this](const http::ClientResponse& answer) {
               const auto list = parse_json(answer.body).value_or(nlohmann::json());
               for (const auto& [name, suit] : client::part_at(list, "inertialSources").items()) {
                 if (const auto id = SensorId::parse(name)) suit_clocks_[*id] = clock_of(suit);
               }
             });
  for (const auto& [name, suit] : sources.items()) {
    const auto id = SensorId::parse(name);
    if (!id) continue;
    suit_clocks_[*id] = clock_of(suit);
    poll_suit(*id, "/inertial/" + name + "/orientations");
  }
}

void LiveRecording::take_suit(const SensorId& source, const std::string& topic,
                              const http::ClientResponse& answer) {
  auto read = resource::read_orientations(answer.body, resource::Format::Json);
  if (!read) return counts_[topic].cannot_read(read.error());
  if (left_over(topic, read->captured + suit_clocks_[source].applied, received(answer))) return;
  counts_[topic].take(read->sequence);
  recorder_->offer(record::RawOrientations{
      source, std::make_shared<const resource::OrientationsResource>(std::move(*read)),
      received(answer), suit_clocks_[source]});
}

bool LiveRecording::left_over(const std::string& topic, Timestamp captured, Timestamp received) {
  // If a host's clock is wrong by more than that and its offset unknown, only the first frame is
  // lost.
  const bool old = received - captured > record::kLeftOverAfter;
  const auto entry =
      left_over_.try_emplace(topic, old ? std::optional(captured) : std::nullopt).first;
  return entry->second == captured;
}

void LiveRecording::take_raw(const SensorId& sensor, const std::string& topic,
                             const http::ClientResponse& answer) {
  auto frame = resource::read_frame(answer.body, resource::Format::Turtle);
  if (!frame) return counts_[topic].cannot_read(frame.error());
  if (left_over(topic, frame->captured + clocks_[sensor].applied, received(answer))) return;
  counts_[topic].take(frame->sequence);
  record::RawFrame raw{sensor,
                       std::make_shared<const resource::FrameResource>(std::move(*frame)),
                       received(answer),
                       {},
                       clocks_[sensor]};
  if (const auto floor = floors_.find(sensor); floor != floors_.end()) raw.floor = floor->second;
  recorder_->offer(std::move(raw));
}

void LiveRecording::take_fused(const http::ClientResponse& answer) {
  auto frame = resource::read_frame(answer.body, resource::Format::Turtle);
  if (!frame) return counts_[fused_topic()].cannot_read(frame.error());
  if (left_over(fused_topic(), frame->captured, received(answer))) return;
  counts_[fused_topic()].take(frame->sequence);
  const Timestamp instant = frame->captured;
  recorder_->offer(record::FusedFrame{instant, received(answer),
                                      [frame = std::make_shared<const resource::FrameResource>(
                                           std::move(*frame))] { return *frame; }});
}

void LiveRecording::take_clocks(const http::ClientResponse& answer) {
  const auto list = parse_json(answer.body).value_or(nlohmann::json());
  for (const auto& [name, sensor] : client::part_at(list, "sensors").items()) {
    if (const auto id = SensorId::parse(name)) clocks_[*id] = clock_of(sensor);
  }
}

void LiveRecording::take_registration(const http::ClientResponse& answer) {
  const auto document = parse_json(answer.body, {.bytes = answer.body.size()});
  if (document && document->is_object() && client::part_at(*document, "sensors").empty()) {
    troubles_["/registration"] =
        "no sensor is registered yet (chorus register), so the recording says of none where it "
        "stands";
    return;
  }
  const auto registration = wire::read_registration(answer.body);
  if (!registration) troubles_["/registration"] = to_string(registration.error());
  if (!registration || registration->sensors.empty()) return;
  recorder_->offer(wire::places_changed(received(answer), *registration));
}

std::chrono::steady_clock::duration LiveRecording::silence() const {
  std::chrono::steady_clock::time_point latest{};
  for (const client::LivePoll& one : polls_) latest = std::max(latest, one.answered());
  return std::chrono::steady_clock::now() - latest;
}

record::RecordingReport LiveRecording::stop() {
  for (client::LivePoll& one : polls_) one.stop();
  recorder_->ask_to_stop();
  (void)recorder_->wait(kFileWithin);
  return recorder_->report();
}

}  // namespace chorus::ctl
