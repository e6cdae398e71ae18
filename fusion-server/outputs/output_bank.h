// The outputs that are open now, as one sink: a reload opens, closes and changes them while frames
// go on.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fusion-server/outputs/outputs.h"
#include "fusion-server/sink.h"

namespace chorus::outputs {

/// Thread-safe.
class OutputBank final : public Sink {
 public:
  explicit OutputBank(OutputsContext context) : context_(std::move(context)) {}
  ~OutputBank() override;

  /// Opens what is enabled, closes what is not, and opens anew what has changed; the others go on
  /// undisturbed.  The error of the first one that cannot be opened; it stays closed, and the
  /// others are open all the same.
  Result<void> apply(const OutputsConfig& config);

  [[nodiscard]] std::string_view name() const override { return "outputs"; }
  void publish(std::shared_ptr<const Snapshot> snapshot) override;
  [[nodiscard]] std::vector<OutputStatus> states() const;

 private:
  struct Place {
    std::string error;
    std::shared_ptr<Sink> sink;  ///< Null: it is not enabled, or could not be opened.
    bool enabled = false;
  };
  /// Replaces one output; the old one is closed before the new one is opened, because both may want
  /// the same port.
  Result<void> replace(std::size_t index, const OutputsConfig& config);

  OutputsContext context_;
  std::mutex applying_;       ///< One apply() at a time.
  mutable std::mutex mutex_;  ///< Guards places_; never held while an output opens or closes.
  std::vector<Place> places_;
  OutputsConfig config_;
};

}  // namespace chorus::outputs
