// Collects bodies that come row by row into frames.  Private to this folder's .cpp files.
#pragma once

#include "common/importers/import_options.h"
#include "common/importers/text_rows.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

class Instants {
 public:
  Instants(const ImportOptions& options, record::FrameRecording& recording)
      : options_(options), recording_(recording) {}

  /// Adds a frame for this instant, which may stay without bodies.
  [[nodiscard]] Result<void> reach(const LineReader& at, Timestamp captured);
  /// The body with this id at this instant, added if it is new.  Refuses instants that go back, too
  /// many frames, and too many bodies; `at` names the row.
  [[nodiscard]] Result<BodyFrame*> body(const LineReader& at, Timestamp captured, BodyId id);

 private:
  const ImportOptions& options_;
  record::FrameRecording& recording_;
};

}  // namespace chorus::importers
