// Frames and bodies as HTTP documents; each format is rendered when the first client asks for it.
#pragma once

#include <memory>
#include <optional>

#include "common/http/document.h"
#include "common/resource/frame_resource.h"

namespace chorus::resource {

using FramePtr = std::shared_ptr<const FrameResource>;

/// The document of `/frame` (place "frame"), of one of `/frames/{seq}` (place "frames/42") or of a
/// relayed frame, in Turtle, JSON-LD, JSON and N-Triples; profile "arvida" in Turtle and N-Triples;
/// form "pose" in JSON.
[[nodiscard]] http::DocumentPtr frame_document(FramePtr frame, const Place& place,
                                               http::DocumentOptions options);

/// The options of these documents.  The version is the sequence, with `run`, so that the ETags of a
/// restarted service differ. latest_options(): `/frame` is revalidated; its Content-Location is its
/// immutable copy. kept_options(): `/frames/{seq}` may be cached for a minute.
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
