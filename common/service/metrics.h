// What a service measures of itself, written for Prometheus (text format 0.0.4).
//
// Counters end in _total, names carry their unit; no label is ever per body or client.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/histogram.h"
#include "common/http/server.h"

namespace chorus::service {

using Labels = std::vector<std::pair<std::string, std::string>>;

/// Collects samples and writes them as one text; a metric's help appears once, before its first
/// sample.
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

  /// Samples of one metric stand together, whatever the order of the calls.
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

/// chorus_http_*: what every server counts.
void add_server(MetricsText& text, const http::ServerCounters& counters);

}  // namespace chorus::service
