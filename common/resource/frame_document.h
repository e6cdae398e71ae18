// Frames and bodies as HTTP documents: every format, rendered when the first client asks.
#pragma once

#include <memory>
#include <optional>

#include "common/http/document.h"
#include "common/resource/frame_resource.h"

namespace chorus::resource {

using FramePtr = std::shared_ptr<const FrameResource>;

/// `/frame` (place "frame") or one of `/frames/{seq}` (place "frames/42"), which is immutable and
/// cached for ever.  Turtle, JSON-LD, JSON, N-Triples; profile "arvida" in Turtle and N-Triples.
/// The ETag's version is the sequence; `/frame` names its immutable twin in Content-Location when
/// `kept` (the service has it).
[[nodiscard]] http::DocumentPtr frame_document(FramePtr frame, const Place& place = {"frame", {}},
                                               bool kept = true);

/// `/skeletons/{id}`; null when the frame has no such body.
[[nodiscard]] http::DocumentPtr skeleton_document(FramePtr frame, std::uint64_t body_id,
                                                  const Place& place);

/// `/skeletons/`: an LDP container of the bodies in the frame.
[[nodiscard]] http::DocumentPtr skeletons_document(const FrameResource& frame, const Place& place);

}  // namespace chorus::resource
