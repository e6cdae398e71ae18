#include "fusion-server/rest/metrics.h"

namespace chorus::rest {
namespace {

using Metric = service::MetricsText::Metric;

double number(std::uint64_t count) { return static_cast<double>(count); }

void add_fates(service::MetricsText& out, const SensorStatus& s) {
  const FrameFates& f = s.fates;
  for (const auto& [fate, count] : {std::pair{"late", f.late},
                                    {"doubled", f.doubled},
                                    {"early", f.early},
                                    {"backwards", f.backwards},
                                    {"stale", f.stale},
                                    {"clock-set-back", f.restarts}}) {
    out.counter({"chorus_frames_untimely_total",
                 "Frames whose time was not as it should be, by what became of them."},
                number(count), {{"sensor", s.id.str()}, {"fate", fate}});
  }
}

void add_frames(service::MetricsText& out, const SensorStatus& s, const service::Labels& labels) {
  out.counter({"chorus_frames_received_total", "Frames received from the sensor."},
              number(s.frames), labels);
  out.counter({"chorus_frames_missed_total", "Gaps in the sensor's own sequence."},
              number(s.missed), labels);
  out.counter(
      {"chorus_frames_refused_total",
       "Frames left out because of their time; unreadable ones count as failures of polling."},
      number(s.refused), labels);
  add_fates(out, s);
  out.counter({"chorus_poll_failures_total", "Requests without a usable answer."},
              number(s.failures), labels);
}

void add_sensor(service::MetricsText& out, const SensorStatus& s) {
  const service::Labels labels{{"sensor", s.id.str()}};
  out.gauge({"chorus_sensor_up", "1 while the sensor delivers frames."},
            s.state == "live" ? 1.0 : 0.0, labels);
  if (s.age) {
    out.gauge({"chorus_frame_age_seconds", "Age of the sensor's newest frame."}, seconds(*s.age),
              labels);
  }
  if (const auto offset = total_offset(s)) {
    out.gauge({"chorus_clock_offset_seconds", "Our clock minus the sensor's."}, seconds(*offset),
              labels);
  }
  if (s.weight) {
    out.gauge({"chorus_view_weight",
               "Largest weight of the sensor's views by Otto's Eqs. 1-3; only where the fusion "
               "method uses it."},
              *s.weight, labels);
  }
  out.gauge({"chorus_sensor_share", "Fused joints of the last second the sensor contributed to."},
            s.share, labels);
  out.gauge({"chorus_sensor_moved",
             "1 while an alarm says that the sensor may not stand where it was registered."},
            s.alarm.empty() ? 0.0 : 1.0, labels);
  out.counter({"chorus_sensor_contested_total",
               "Bodies that the sensor saw and that were not published, because others look there "
               "and see nobody, or nobody can stand there."},
              number(s.contests), labels);
  if (s.shift) {
    out.gauge({"chorus_sensor_displacement_meters",
               "How far from the others the sensor sees people now, beyond what is usual for it."},
              *s.shift, labels);
  }
  add_frames(out, s, labels);
}

void add_output(service::MetricsText& out, const OutputStatus& output) {
  const service::Labels labels{{"output", output.name}};
  const SinkCounters& counters = output.counters;
  out.gauge({"chorus_output_open", "0 while the output could not be opened; see /outputs/."},
            output.error.empty() ? 1.0 : 0.0, labels);
  out.counter({"chorus_output_frames_total", "Fused frames handed to the protocol."},
              number(counters.frames), labels);
  out.counter({"chorus_output_dropped_total",
               "Fused frames left out because the output did not keep up (the oldest go first)."},
              number(counters.dropped), labels);
  out.counter({"chorus_output_failed_total",
               "Sends the operating system refused, and frames that could not be sent at all."},
              number(counters.failed), labels);
  out.counter({"chorus_output_refused_total", "Clients or messages turned away."},
              number(counters.refused), labels);
  out.gauge({"chorus_output_clients", "Clients connected."}, number(counters.clients), labels);
}

}  // namespace

std::string metrics_text(const Status& status, const std::vector<OutputStatus>& outputs,
                         const http::ServerCounters& http) {
  service::MetricsText out;
  const Counters& counters = status.counters;
  out.counter({"chorus_fused_frames_total", "Fused frames published."}, number(counters.ticks));
  out.counter({"chorus_skipped_frames_total", "Instants left out because we were too late."},
              number(counters.ticks_skipped));
  out.counter({"chorus_dropped_frames_total",
               "Sensor frames dropped because the pipeline did not keep up."},
              number(counters.frames_dropped));
  out.counter({"chorus_fusion_seconds_total", "Time spent on fusing frames and handing them over."},
              counters.step_seconds);
  out.counter({"chorus_pipeline_failures_total", "Turns of the pipeline that broke; see the log."},
              number(counters.steps_failed));
  out.counter(
      {"chorus_worker_failures_total", "Jobs of the registration worker that broke; see the log."},
      number(counters.jobs_failed));
  out.histogram({"chorus_fused_frame_age_seconds", "Instant to publication of fused frames."},
                counters.age);
  out.gauge({"chorus_registration_version", "Version of the registration in use."},
            number(status.registration.version));
  out.gauge({"chorus_registered_sensors", "Sensors with a place."},
            number(status.registration.sensors.size()));
  out.counter({"chorus_sensors_moved_total", "Times a sensor lost its place as it was moved."},
              number(counters.displaced));
  out.gauge({"chorus_registration_stored",
             "1 while the registration in use survives a restart; see /registration."},
            stored(status.progress) ? 1.0 : 0.0);
  for (const SensorStatus& sensor : status.sensors) add_sensor(out, sensor);
  for (const OutputStatus& output : outputs) add_output(out, output);
  service::add_server(out, http);
  return out.text();
}

}  // namespace chorus::rest
