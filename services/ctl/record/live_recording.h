// Records a running service over HTTP: a sensor, or a fusion server with its sensors.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/client/live_poll.h"
#include "common/record/recorder.h"

namespace chorus::ctl {

struct LiveRecordingOptions {
  http::Url service;
  std::string file;
  bool raw = true;
  bool fused = true;
  bool site = false;  ///< The fused frames are those of the hall, /site/frame, and nothing is raw.
};

/// Runs on the io_context's thread; only the file is written on the recorder's thread.  A frame
/// that was left over from before the recording (record::kLeftOverAfter) is neither counted nor
/// recorded.
class LiveRecording {
 public:
  /// Asks the service for its description and begins.  Errors: the service does not answer, is not
  /// a Chorus service, or the file cannot be created.
  [[nodiscard]] static Result<std::unique_ptr<LiveRecording>> start(asio::io_context& io,
                                                                    LiveRecordingOptions options);
  /// Ends polling and waits, for 30 s at most, until everything is written.
  [[nodiscard]] record::RecordingReport stop();

  /// The counts of each topic, such as "/frame" or "/sensors/s1/frame"; from the start there is an
  /// entry for every topic that the service announced.
  [[nodiscard]] const std::map<std::string, client::StreamCount>& counts() const { return counts_; }
  /// The last errors in reading resources other than frames (clocks, registration), by path.
  [[nodiscard]] const std::map<std::string, std::string>& troubles() const { return troubles_; }
  /// Time since the last answer to any request.
  [[nodiscard]] std::chrono::steady_clock::duration silence() const;

 private:
  [[nodiscard]] const char* fused_topic() const { return options_.site ? "/site/frame" : "/frame"; }

  LiveRecording(asio::io_context& io, LiveRecordingOptions options, tls::Trust trust)
      : io_(io), options_(std::move(options)), trust_(std::move(trust)) {}

  using Take = std::function<void(const http::ClientResponse&)>;
  void poll_frames(const std::string& topic, Take take, const std::string& accept = "text/turtle");
  void poll_state(client::LivePoll::Options what, Take take);
  void poll_raw(const SensorId& sensor, const std::string& prefix);
  void poll_tracker(const nlohmann::json& sensors);
  /// What worn inertial sensors say, of one source or of all that a tracker follows.
  void poll_suit(const SensorId& source, const std::string& topic);
  void poll_suits(const nlohmann::json& listed);
  void take_suit(const SensorId& source, const std::string& topic,
                 const http::ClientResponse& answer);
  void take_raw(const SensorId& sensor, const std::string& topic,
                const http::ClientResponse& answer);
  void take_fused(const http::ClientResponse& answer);
  /// Whether this is the frame that the topic began with and that was left over from before.
  bool left_over(const std::string& topic, Timestamp captured, Timestamp received);
  void take_clocks(const http::ClientResponse& answer);
  void take_registration(const http::ClientResponse& answer);

  asio::io_context& io_;
  LiveRecordingOptions options_;
  tls::Trust trust_;
  std::unique_ptr<record::Recorder> recorder_;
  std::deque<client::LivePoll> polls_;
  std::map<std::string, client::StreamCount> counts_;
  std::map<std::string, std::string> troubles_;
  /// The capture time of the frame that a topic began with, if it was left over.
  std::map<std::string, std::optional<Timestamp>> left_over_;
  std::map<SensorId, record::ClockModel> clocks_;
  std::map<SensorId, record::ClockModel> suit_clocks_;
  std::map<SensorId, FloorPlane> floors_;
};

}  // namespace chorus::ctl
