#include "fusion-server/server/lookout.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "common/base/log.h"

namespace chorus::server {
namespace {

constexpr auto kDiskInterval = std::chrono::seconds(5);

journal::Glimpse glimpse_of(const Status& status) {
  journal::Glimpse now;
  now.sensors = status.sensors;
  now.registration = status.registration;
  now.sessions = status.progress.sessions;
  now.proposal = status.progress.proposal.has_value();
  now.storage_trouble = status.progress.storage.trouble;
  return now;
}

void note(const journal::Event& event) {
  // Warnings are logged where they arise; here the log gets one line of each event for `debug`.
  log::debug("event", {{"kind", event.kind}, {"about", event.about}, {"what", event.message}});
}

}  // namespace

Lookout::Lookout(LookoutOptions options)
    : options_(std::move(options)),
      people_(options_.serving, options_.remember, options_.forget),
      // Ids grow across restarts: no server has a thousand events a second.
      events_(options_.serving,
              static_cast<std::uint64_t>(to_unix_ns(options_.clock->now()) / 1'000'000)) {}

void Lookout::add_routes(http::Router& router) {
  people_.add_routes(router);
  events_.add_routes(router);
}

std::optional<journal::RecordingGlimpse> Lookout::recording() const {
  const auto report = options_.newest_recording();
  if (!report) return std::nullopt;
  journal::RecordingGlimpse one;
  one.name = report->name;
  one.running = report->state == record::RecordingState::Recording;
  if (report->state == record::RecordingState::Failed) one.trouble = report->reason;
  return one;
}

void Lookout::look_at_disk() {
  const auto now = std::chrono::steady_clock::now();
  if (options_.recording.folder.empty() || now - disk_at_ < kDiskInterval) return;
  disk_at_ = now;
  std::error_code failed;
  const auto space = std::filesystem::space(options_.recording.folder, failed);
  disk_free_ = failed ? std::nullopt : std::optional(static_cast<double>(space.available));
}

void Lookout::look(const Status& status) {
  look_at_disk();
  journal::Glimpse now = glimpse_of(status);
  now.time = options_.clock->now();
  now.outputs = options_.outputs();
  now.recording = recording();
  now.disk_free = disk_free_;
  now.disk_least = static_cast<double>(options_.recording.limits.min_free_bytes);
  now.people = people_.people();
  for (const journal::Event& event : events_.look(std::move(now))) note(event);
}

}  // namespace chorus::server
