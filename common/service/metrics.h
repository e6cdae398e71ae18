// What a service measures about itself, written for Prometheus (text format 0.0.4).
//
// Counters end in _total; names contain their unit; no label names a body or a client.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/histogram.h"
#include "common/http/server.h"

namespace chorus::service {

using Labels = std::vector<std::pair<std::string, std::string>>;

/// Collects samples and writes them in Prometheus' text format; the help of each metric appears
/// once, before its first sample.
class MetricsText {
 public:
  struct Metric {
    std::string_view name;  ///< [a-zA-Z_:][a-zA-Z0-9_:]*
    std::string_view help;
  };

  void counter(const Metric& metric, double value, const Labels& labels = {});
  void gauge(const Metric& metric, double value, const Labels& labels = {});
  void histogram(const Metric& metric, const Histogram::Snapshot& values,
                 const Labels& labels = {});

  /// All samples, grouped by metric whatever the order of the calls was.
  [[nodiscard]] std::string text() const;

 private:
  struct Family {
    std::string name;
    std::string head;
    std::string samples;
  };
  std::string& samples_of(const Metric& metric, std::string_view type);

  std::vector<Family> families_;
};

/// Adds chorus_http_*: the counters of every server.
void add_server(MetricsText& text, const http::ServerCounters& counters);

}  // namespace chorus::service
