// Frames for the tests in this folder: random but valid, and the graph that each one stands for.
#pragma once

#include <cstdint>
#include <string>

#include "common/rdf/term.h"
#include "common/resource/frame_resource.h"

namespace chorus::resource {

struct FrameKind {
  std::size_t bodies = 2;
  bool fused = false;  ///< In world space, with variances and contributors.
};

/// A different frame for each seed; numbers are already rounded as on the wire.
[[nodiscard]] FrameResource random_frame(std::uint64_t seed, const FrameKind& kind = {});

/// The triples of the compact profile, written out one by one from the specification.
[[nodiscard]] rdf::Graph expected_graph(const FrameResource& frame);

/// As on the wire; -0 is 0.
[[nodiscard]] std::string decimals(double value, int digits);

/// The first difference; empty when they are equal.
[[nodiscard]] std::string difference(const FrameResource& a, const FrameResource& b);

}  // namespace chorus::resource
