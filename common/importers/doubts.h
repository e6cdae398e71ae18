// What is probably wrong with recordings that could be imported.
//
// Nothing here is an error: each of these can be meant, so the import is done, and the sentence
// says what to look at.
#pragma once

#include <string>
#include <vector>

#include "common/importers/file_space.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

/// Sentences about recordings with nobody in them, with seconds between their frames, and in which
/// people lie or stand on their heads, are unusually small or tall, or have fewer than eight
/// joints; each begins with the sensor's id.  `spaces`: how the files' coordinates became ours.
[[nodiscard]] std::vector<std::string> doubts_about(
    const std::vector<record::FrameRecording>& recordings, const FileSpaces& spaces = {});

/// A sentence if cameras whose pictures are counted from `start`, this many a second, do not begin
/// with the same number: one may count from 0 and another one from 1.
[[nodiscard]] std::vector<std::string> numbering_doubts(
    const std::vector<record::FrameRecording>& recordings, Timestamp start, double rate_hz);

}  // namespace chorus::importers
