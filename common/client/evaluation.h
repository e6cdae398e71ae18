// Following /evaluation: what a chorus-evaluation says of a tracker.
#pragma once

#include <cstdint>
#include <string>

#include "common/client/document_kind.h"

namespace chorus::client {

/// The document as it was sent, in JSON: whoever relays it needs no more than its number and time.
struct EvaluationText {
  std::uint64_t sequence = 0;
  Timestamp captured;
  std::string json;
};

/// Asked for in JSON; refused where it is no Evaluation.
extern const KindOf<EvaluationText> kEvaluations;

}  // namespace chorus::client
