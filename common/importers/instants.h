// Groups bodies, which are read row by row, into frames by their capture times.  Private to this
// folder's .cpp files.
#pragma once

#include "common/importers/import_options.h"
#include "common/importers/text_rows.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

class Instants {
 public:
  Instants(const ImportOptions& options, record::FrameRecording& recording)
      : options_(options), recording_(recording) {}

  /// Adds a frame for this instant if there is none; the frame may stay without bodies.
  [[nodiscard]] Result<void> reach(const LineReader& at, Timestamp captured);
  /// Returns the body with this id at this instant, adding it if it is new; the pointer is valid
  /// until the next call.  Refuses an instant before the last one, too many frames, and too many
  /// bodies; `at` names the row in error messages.
  [[nodiscard]] Result<BodyFrame*> body(const LineReader& at, Timestamp captured, BodyId id);

 private:
  const ImportOptions& options_;
  record::FrameRecording& recording_;
};

}  // namespace chorus::importers
