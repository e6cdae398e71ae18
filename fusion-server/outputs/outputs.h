// All outputs except REST, as the configuration section "outputs" enables them.
//
// Each protocol has a folder; VMC and VRChat share one. NAME_outlet.h has the sender of the
// protocol NAME, its settings and its factory; in most folders, NAME_encoder.h converts a
// TrackerFrame to bytes (pure). outputs.cpp lists the protocols.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/result.h"
#include "common/time/clock.h"
#include "fusion-server/dtrack/dtrack_outlet.h"
#include "fusion-server/mqtt/mqtt_outlet.h"
#include "fusion-server/mxtp/mxtp_outlet.h"
#include "fusion-server/natnet/natnet_outlet.h"
#include "fusion-server/osc/vmc_outlet.h"
#include "fusion-server/osc/vrchat_outlet.h"
#include "fusion-server/outlet/outlet.h"
#include "fusion-server/trackd/trackd_outlet.h"
#include "fusion-server/vrpn/vrpn_outlet.h"

namespace chorus::outputs {

/// The keys that all outputs have in common.
struct OutputSetting {
  bool enabled = false;
  outlet::Latency latency = outlet::Latency::Exact;
  int max_persons = 6;

  bool operator==(const OutputSetting&) const = default;
};

template <class ProtocolSettings>
struct Output {
  OutputSetting common;
  ProtocolSettings protocol;

  bool operator==(const Output&) const = default;
};

struct OutputsConfig {
  Output<mxtp::Settings> mxtp;
  Output<dtrack::Settings> dtrack;
  Output<trackd::Settings> trackd;
  Output<vmc::Settings> vmc;
  Output<vrchat::Settings> vrchat;
  Output<vrpn::Settings> vrpn;
  Output<natnet::Settings> natnet;
  Output<mqtt::Settings> mqtt;

  bool operator==(const OutputsConfig&) const = default;
};

/// Reads the section; the reader's finish() reports mistakes.
void read_outputs(ConfigReader reader, OutputsConfig& out);

/// "mxtp", "dtrack", ...: the keys of all outputs; the functions below take an index into them.
[[nodiscard]] const std::vector<std::string_view>& output_names();
[[nodiscard]] bool is_enabled(const OutputsConfig& config, std::size_t index);
[[nodiscard]] bool same_output(const OutputsConfig& a, const OutputsConfig& b, std::size_t index);

/// What all outputs get: the time, and which things are in whose hands (null: there are none).
struct OutputsContext {
  std::shared_ptr<const Clock> clock;
  std::shared_ptr<const workplace::PropBoard> board = {};
};

/// Opens one output, enabled or not.  The error's context begins with "outputs.NAME".
[[nodiscard]] Result<std::unique_ptr<Sink>> open_output(const OutputsConfig& config,
                                                        std::size_t index,
                                                        const OutputsContext& context);

/// Opens the enabled outputs.  Returns the error of the first one that cannot be opened.
[[nodiscard]] Result<std::vector<std::unique_ptr<Sink>>> open_outputs(
    const OutputsConfig& config, const OutputsContext& context);

/// The smallest max_persons of the enabled outputs, all of which show the slots below it; the
/// default max_persons if no output is enabled.
[[nodiscard]] std::size_t slots_of_all(const OutputsConfig& config);

}  // namespace chorus::outputs
