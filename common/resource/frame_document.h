// Frames and bodies as HTTP documents: each format is rendered when the first client asks for it.
#pragma once

#include <memory>
#include <optional>

#include "common/http/document.h"
#include "common/resource/frame_resource.h"

namespace chorus::resource {

using FramePtr = std::shared_ptr<const FrameResource>;

/// `/frame` (place "frame"), one of `/frames/{seq}` (place "frames/42") or a relayed frame. Turtle,
/// JSON-LD, JSON and N-Triples; profile "arvida" in Turtle and N-Triples.
[[nodiscard]] http::DocumentPtr frame_document(FramePtr frame, const Place& place,
                                               http::DocumentOptions options);

/// The options of these documents: version = sequence (and `run`, so that the ETags of a restarted
/// service differ).
/// `/frame` is revalidated, with its immutable twin in Content-Location; `/frames/{seq}` is cached
/// for a minute.
[[nodiscard]] http::DocumentOptions latest_options(const FrameResource& frame,
                                                   const std::string& run = {});
[[nodiscard]] http::DocumentOptions kept_options(const FrameResource& frame,
                                                 const std::string& run = {});

/// `/skeletons/{id}`; null when the frame has no such body.
[[nodiscard]] http::DocumentPtr skeleton_document(FramePtr frame, std::uint64_t body_id,
                                                  const Place& place,
                                                  http::DocumentOptions options);

/// `/skeletons/`: an LDP container of the bodies in the frame.
[[nodiscard]] http::DocumentPtr skeletons_document(const FrameResource& frame, const Place& place,
                                                   http::DocumentOptions options);

}  // namespace chorus::resource
