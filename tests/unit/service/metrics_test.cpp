#include "common/service/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace chorus::service {
namespace {

TEST(MetricsText, WritesHelpTypeAndSamples) {
  MetricsText text;
  text.counter({"frames_total", "Frames captured."}, 42);
  text.gauge({"age_seconds", "Age of the newest frame."}, 0.025, {{"sensor", "s1"}});
  EXPECT_EQ(text.text(),
            "# HELP frames_total Frames captured.\n"
            "# TYPE frames_total counter\n"
            "frames_total 42\n"
            "# HELP age_seconds Age of the newest frame.\n"
            "# TYPE age_seconds gauge\n"
            "age_seconds{sensor=\"s1\"} 0.025\n");
}

TEST(MetricsText, SamplesOfOneMetricStandTogether) {
  MetricsText text;
  for (const auto sensor : {"s1", "s2"}) {
    text.gauge({"a", "A."}, 1, {{"sensor", sensor}});
    text.gauge({"b", "B."}, 2, {{"sensor", sensor}});
  }
  EXPECT_EQ(text.text(),
            "# HELP a A.\n# TYPE a gauge\na{sensor=\"s1\"} 1\na{sensor=\"s2\"} 1\n"
            "# HELP b B.\n# TYPE b gauge\nb{sensor=\"s1\"} 2\nb{sensor=\"s2\"} 2\n");
}

TEST(MetricsText, EscapesHelpAndLabels) {
  MetricsText text;
  text.gauge({"a", "back\\slash\nline \"quoted\""}, 1, {{"l", "\\ \n \""}});
  EXPECT_EQ(text.text(),
            "# HELP a back\\\\slash\\nline \"quoted\"\n# TYPE a gauge\n"
            "a{l=\"\\\\ \\n \\\"\"} 1\n");
}

TEST(MetricsText, ValuesThatAreNoNumbers) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  MetricsText text;
  for (const double value : {std::nan(""), kInfinity, -kInfinity, 1e21, -0.5})
    text.gauge({"a", "A."}, value);
  EXPECT_EQ(text.text(), "# HELP a A.\n# TYPE a gauge\na NaN\na +Inf\na -Inf\na 1e+21\na -0.5\n");
}

TEST(Histogram, BucketsAreCumulativeOnTheWire) {
  Histogram ages({0.125, 0.5, 1.0});
  for (const double age : {0.0625, 0.125, 0.25, 2.0, std::nan("")}) ages.observe(age);
  MetricsText text;
  text.histogram({"age_seconds", "Age."}, ages.snapshot(), {{"at", "send"}});
  EXPECT_EQ(text.text(),
            "# HELP age_seconds Age.\n# TYPE age_seconds histogram\n"
            "age_seconds_bucket{at=\"send\",le=\"0.125\"} 2\n"
            "age_seconds_bucket{at=\"send\",le=\"0.5\"} 3\n"
            "age_seconds_bucket{at=\"send\",le=\"1\"} 3\n"
            "age_seconds_bucket{at=\"send\",le=\"+Inf\"} 4\n"
            "age_seconds_sum{at=\"send\"} 2.4375\n"
            "age_seconds_count{at=\"send\"} 4\n");
}

TEST(AddServer, NamesEveryCounter) {
  http::ServerCounters counters;
  counters.requests = 7;
  counters.long_polls_waiting = 3;
  MetricsText text;
  add_server(text, counters);
  EXPECT_NE(text.text().find("\nchorus_http_requests_total 7\n"), std::string::npos);
  EXPECT_NE(text.text().find("\nchorus_http_longpoll_waiters 3\n"), std::string::npos);
}

}  // namespace
}  // namespace chorus::service
