// What a POST /recordings/ asks for.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/time/timestamp.h"

namespace chorus::service {

/// The body of POST /recordings/.
struct RecordingRequest {
  std::string name;      ///< Empty: the UTC time.
  Duration duration{0};  ///< Zero: until stopped.
  bool raw = true;
  bool fused = true;
};
/// Parses the body.  An empty body asks for everything.  Unknown keys, wrong types and invalid
/// recording names are InvalidArgument.
[[nodiscard]] Result<RecordingRequest> parse_recording_request(std::string_view body,
                                                               bool has_fused);

}  // namespace chorus::service
