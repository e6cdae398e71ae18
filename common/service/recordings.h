// /recordings/: what this service is recording and has recorded.  All services have it.
//
// There is at most one recording at a time.  POST /recordings/ starts it, DELETE /recordings/{name}
// ends it; no request ever deletes a file (docs/decisions/0011-recordings.md).
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/config_reader.h"
#include "common/http/router.h"
#include "common/record/recorder.h"
#include "common/resource/node.h"
#include "common/service/metrics.h"
#include "common/service/recording_request.h"
#include "common/service/serving.h"

namespace chorus::service {

struct RecordingConfig {
  std::string folder;  ///< Empty: nothing is recorded.
  record::RecorderLimits limits;

  bool operator==(const RecordingConfig&) const = default;
};

/// Reads the configuration section "recording", the same for every service.
void read_recording(ConfigReader config, RecordingConfig& out);

/// `id` is the node's IRI in the document ("" in /recordings/{name}).
[[nodiscard]] resource::Node recording_node(const record::RecordingReport& report, std::string id);

struct RecordingsOptions {
  RecordingConfig config;
  record::CellHead head;   ///< Written into every file.
  bool has_fused = false;  ///< True for a fusion server.
  Serving serving;
  std::shared_ptr<const Clock> clock = std::make_shared<SystemClock>();
};

/// Thread-safe.
class Recordings {
 public:
  explicit Recordings(RecordingsOptions options);
  ~Recordings();  ///< Ends the running recording and waits for its file.

  enum class Stream { Raw, Fused, Any };
  /// The recorder that gets this stream's items; null while the stream is not being recorded.
  [[nodiscard]] std::shared_ptr<record::Recorder> recorder(Stream stream) const;

  /// The newest recording of this run, whether it runs or has ended; none: nothing was recorded.
  [[nodiscard]] std::optional<record::RecordingReport> newest() const;

  /// The files of a recording that has ended.  NotFound when none has this name; Unavailable while
  /// it is being written.
  [[nodiscard]] Result<std::vector<std::filesystem::path>> files_of(const std::string& name) const;
  /// Lists a recording that was made in the folder by something else than start().
  void adopt(const record::RecordingReport& report);

  [[nodiscard]] Result<record::RecordingReport> start(const RecordingRequest& request);
  /// Ends a recording without waiting (state `stopping`); does nothing if it has already ended.
  /// NotFound when none has this name.
  [[nodiscard]] Result<record::RecordingReport> stop(std::string_view name);

  /// Writes a mark into the running recording of this name, at the present: how long after its
  /// beginning that was [s].  None: it does not run; Unavailable: it is ending.
  [[nodiscard]] Result<std::optional<double>> mark(std::string_view name, const std::string& text);

  /// The metrics chorus_recording_* in Prometheus' text format.
  [[nodiscard]] std::string metrics_text() const;

  /// The router keeps using this object, which must outlive the router.
  void add_routes(http::Router& router);

 private:
  struct Running {
    std::shared_ptr<record::Recorder> recorder;
    bool raw = false;
    bool fused = false;
  };

  [[nodiscard]] record::RecorderOptions options_for(const RecordingRequest& request) const;
  void settle();  ///< Takes note of a recording that has ended.  Call it with the mutex held.
  /// At most `most` recordings whose names come after `after`, ordered by name.
  [[nodiscard]] std::map<std::string, record::RecordingReport> some(const std::string& after,
                                                                    std::size_t most) const;
  [[nodiscard]] Result<record::RecordingReport> find(std::string_view name) const;
  [[nodiscard]] Result<http::DocumentPtr> list(const http::Request& request) const;
  [[nodiscard]] http::DocumentPtr description(const record::RecordingReport& report) const;
  [[nodiscard]] Result<http::DocumentPtr> one(const std::string& name) const;
  [[nodiscard]] Result<http::DocumentPtr> file(const std::string& name,
                                               const std::string& file) const;
  [[nodiscard]] Result<http::ActionResult> post(const http::Request& request);

  const RecordingsOptions options_;
  std::mutex starting_;  ///< Lets one start run at a time; threads that offer frames never take it.
  mutable std::mutex mutex_;  ///< Guards the members below; never held during disk access.
  Running running_;
  std::string last_;  ///< Name of the newest one that has ended.
  std::map<std::string, record::RecordingReport> ended_;
  std::uint64_t frames_ended_ = 0;  ///< Frames of this process's ended recordings.
  std::uint64_t dropped_ended_ = 0;
  std::uint64_t failed_ = 0;
};

}  // namespace chorus::service
