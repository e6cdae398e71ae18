// A recording of a cell, or of one sensor, read frame by frame (session_writer.h).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/record/session_reader.h"

namespace chorus::record {

/// A sensor's frame by the recorder's clock, a fused frame, or a registration as JSON.
using SessionItem = std::variant<SensorFrame, resource::FrameResource, std::string>;

/// Takes the memory of a few chunks, however long the recording is.
class SessionStream {
 public:
  /// `files`: as read_session() takes them; each is opened when its turn comes.
  explicit SessionStream(std::vector<std::filesystem::path> files, SessionQuery query = {});
  SessionStream(SessionStream&&) noexcept;
  SessionStream& operator=(SessionStream&&) noexcept;
  ~SessionStream();

  /// The next item in log order; none at the end.  The errors of read_session(), where they occur.
  [[nodiscard]] Result<std::optional<SessionItem>> next();

  /// After the end: what the session holds beside the items.
  [[nodiscard]] Session finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What is read of a recording for such a query.
[[nodiscard]] ReadLimits limits_of(const SessionQuery& query);

}  // namespace chorus::record
