#include "services/sensor/device/camera/camera_resource.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/resource/link_lines.h"

namespace chorus::camera {
namespace {

using Json = nlohmann::json;

Json size_json(Size size) { return {{"width", size.width}, {"height", size.height}}; }

double tenths(double value) { return std::round(value * 10.0) / 10.0; }

Json report_json(const CameraReport& report) {
  Json json{{"state", "live"},
            {"reason", ""},
            {"pictures", {{"received", report.pictures}, {"lookedAt", report.looked_at}}},
            {"opened", report.connects}};
  if (report.picture.width > 0) json["pictures"]["size"] = size_json(report.picture);
  json["runner"] = {{"name", report.runner},
                    {"layout", report.layout},
                    {"started", report.starts},
                    {"answerMilliseconds", tenths(report.answer_ms)},
                    {"latencyMilliseconds", tenths(report.latency_ms)}};
  if (report.sent.width > 0) json["runner"]["size"] = size_json(report.sent);
  if (!report.doubt.empty()) json["doubt"] = report.doubt;
  return json;
}

/// While there is trouble.
const char* state_of(const CameraReport& report) {
  if (report.over) return "ended";
  if (!report.source_trouble.empty()) return "no pictures";
  return report.lens_fits ? "no runner" : "wrong lens";
}

}  // namespace

void add_camera_route(http::Router& router, std::string source,
                      std::shared_ptr<const CameraState> state) {
  const auto answer = [source = std::move(source), state = std::move(state)](
                          const http::Request&,
                          const http::PathParams&) -> Result<http::DocumentPtr> {
    const CameraReport report = state->report();
    Json json = report_json(report);
    json["source"] = source;
    if (report.looked_at == 0) json["state"] = "starting";
    if (const std::string trouble = state->trouble(); !trouble.empty()) {
      json["state"] = state_of(report);
      json["reason"] = trouble;
    }
    http::DocumentOptions options;
    options.version = std::to_string(report.pictures) + "-" + std::to_string(report.looked_at) +
                      "-" + json["state"].get<std::string>();
    options.cache_control = "no-store";
    return resource::other_document("application/json",
                                    json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n",
                                    std::move(options));
  };
  router.get("/camera", answer);
}

}  // namespace chorus::camera
