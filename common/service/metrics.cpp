#include "common/service/metrics.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>

namespace chorus::service {
namespace {

std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

std::string escaped(std::string_view text, bool quotes) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\\\";
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '"' && quotes) {
      out += "\\\"";
    } else {
      out += c;
    }
  }
  return out;
}

/// Used only in assertions; a release build does not call it.
[[maybe_unused]] bool is_name(std::string_view name) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == ':';
  };
  return !name.empty() && !(name[0] >= '0' && name[0] <= '9') &&
         std::all_of(name.begin(), name.end(), fits);
}

void add_sample(std::string& out, std::string_view name, const Labels& labels, double value) {
  out.append(name);
  const char* separator = "{";
  for (const auto& [key, text] : labels) {
    assert(is_name(key));
    out.append(separator).append(key).append("=\"").append(escaped(text, true)).append("\"");
    separator = ",";
  }
  if (!labels.empty()) out.append("}");
  out.append(" ").append(number(value)).append("\n");
}

}  // namespace

std::string& MetricsText::samples_of(const Metric& metric, std::string_view type) {
  assert(is_name(metric.name));
  const auto known = std::find_if(families_.begin(), families_.end(),
                                  [&](const Family& f) { return f.name == metric.name; });
  if (known != families_.end()) return known->samples;
  const std::string name(metric.name);
  return families_
      .emplace_back(Family{name,
                           "# HELP " + name + " " + escaped(metric.help, false) + "\n# TYPE " +
                               name + " " + std::string(type) + "\n",
                           {}})
      .samples;
}

void MetricsText::counter(const Metric& metric, double value, const Labels& labels) {
  assert(metric.name.ends_with("_total"));
  add_sample(samples_of(metric, "counter"), metric.name, labels, value);
}

void MetricsText::gauge(const Metric& metric, double value, const Labels& labels) {
  add_sample(samples_of(metric, "gauge"), metric.name, labels, value);
}

void MetricsText::histogram(const Metric& metric, const Histogram::Snapshot& values,
                            const Labels& labels) {
  std::string& samples = samples_of(metric, "histogram");
  const std::string name(metric.name);
  Labels bounded = labels;
  bounded.emplace_back("le", "");
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < values.counts.size(); ++i) {
    below += values.counts[i];
    bounded.back().second = i < values.bounds.size() ? number(values.bounds[i]) : "+Inf";
    add_sample(samples, name + "_bucket", bounded, static_cast<double>(below));
  }
  add_sample(samples, name + "_sum", labels, values.sum);
  add_sample(samples, name + "_count", labels, static_cast<double>(below));
}

std::string MetricsText::text() const {
  std::string all;
  for (const Family& family : families_) all.append(family.head).append(family.samples);
  return all;
}

void add_server(MetricsText& text, const http::ServerCounters& counters) {
  struct Row {
    std::string_view name;
    std::string_view help;
    std::uint64_t value;
  };
  const std::array totals{
      Row{"chorus_http_requests_total", "Requests answered.", counters.requests},
      Row{"chorus_http_refused_total", "Malformed requests and connections over a limit.",
          counters.refused},
      Row{"chorus_http_not_modified_total", "Answers 304.", counters.not_modified},
      Row{"chorus_http_connections_total", "Connections accepted.", counters.connections_total},
      Row{"chorus_http_events_skipped_total", "Frames that slow event-stream readers did not get.",
          counters.events_skipped},
      Row{"chorus_http_sent_bytes_total", "Bytes sent.", counters.bytes_sent},
      Row{"chorus_http_unauthorized_total", "Requests refused for a wrong token or none.",
          counters.unauthorized},
      Row{"chorus_http_held_total", "Requests that waited because their address asked too much.",
          counters.held},
      Row{"chorus_http_closed_for_room_total", "Idle connections that gave way to others.",
          counters.closed_for_room},
      Row{"chorus_http_handshakes_failed_total", "TLS handshakes that failed.",
          counters.handshakes_failed},
  };
  const std::array now{
      Row{"chorus_http_connections", "Open connections.", counters.connections_open},
      Row{"chorus_http_connections_limit", "Connections that are possible at once.",
          counters.connections_limit},
      Row{"chorus_http_downloads", "Files being sent.", counters.downloads_open},
      Row{"chorus_http_longpoll_waiters", "Long polls waiting.", counters.long_polls_waiting},
      Row{"chorus_http_event_streams", "Open event streams.", counters.event_streams_open},
      Row{"chorus_http_websockets", "Open WebSockets.", counters.websockets_open},
  };
  for (const Row& row : totals) text.counter({row.name, row.help}, static_cast<double>(row.value));
  for (const Row& row : now) text.gauge({row.name, row.help}, static_cast<double>(row.value));
}

}  // namespace chorus::service
