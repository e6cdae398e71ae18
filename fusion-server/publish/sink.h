// The seam between fusion and every output: each protocol is one Sink.
#pragma once

#include <memory>
#include <string_view>

#include "fusion-server/flow.h"

namespace chorus::publish {

/// publish() is called on the pipeline's thread at the output rate and must return at once: a sink
/// that talks to others keeps a Handover and a thread of its own.
class Sink {
 public:
  virtual ~Sink() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  virtual void publish(std::shared_ptr<const Snapshot> snapshot) = 0;
};

}  // namespace chorus::publish
