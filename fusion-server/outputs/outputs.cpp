#include "fusion-server/outputs/outputs.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace chorus::outputs {
namespace {

void read_common(ConfigReader& reader, OutputSetting& out) {
  reader.read("enabled", out.enabled);
  std::size_t latency = static_cast<std::size_t>(out.latency);
  reader.read_choice("latency", latency, {"exact", "predicted"});
  out.latency = static_cast<outlet::Latency>(latency);
  reader.read("max_persons", out.max_persons, 1, outlet::kMaxSlots);
}

/// Calls `visit` for every output: with its key and its settings.
template <class Config, class Visitor>
void for_each_output(Config& config, const Visitor& visit) {
  visit("mxtp", config.mxtp);
  visit("dtrack", config.dtrack);
  visit("trackd", config.trackd);
  visit("vmc", config.vmc);
  visit("vrchat", config.vrchat);
  visit("vrpn", config.vrpn);
  visit("natnet", config.natnet);
}

struct Opening {
  std::shared_ptr<const Clock> clock;
  std::vector<std::unique_ptr<Sink>> sinks;
  Result<void> outcome;
};

/// open_outlet() is found in the protocol's namespace, by argument-dependent lookup.
template <class Setting>
void open_one(std::string_view key, const Setting& output, Opening& opening) {
  if (!output.common.enabled || !opening.outcome) return;
  const outlet::OutletContext context{static_cast<std::size_t>(output.common.max_persons),
                                      opening.clock};
  auto outlet = open_outlet(output.protocol, context);
  if (!outlet) {
    Error error = outlet.error();
    error.context = "outputs." + std::string(key) + ": " + error.context;
    opening.outcome = tl::unexpected<Error>(std::move(error));
    return;
  }
  opening.sinks.push_back(std::make_unique<outlet::OutletSink>(
      std::move(*outlet),
      outlet::OutletTiming{output.common.latency, context.slots, context.clock}));
}

}  // namespace

void read_outputs(ConfigReader reader, OutputsConfig& out) {
  for_each_output(out, [&reader](std::string_view key, auto& output) {
    ConfigReader child = reader.child(key);
    read_common(child, output.common);
    read_settings(child, output.protocol);
    if constexpr (requires { output.protocol.slot; }) {
      if (output.protocol.slot >= output.common.max_persons) {
        child.complain("slot", "must be below max_persons; nobody has this slot");
      }
      for (const outlet::PersonTargets& person : output.protocol.persons) {
        if (person.slot < output.common.max_persons) continue;
        child.complain("persons", "has a slot that is not below max_persons; nobody has it");
      }
    }
  });
}

Result<std::vector<std::unique_ptr<Sink>>> open_outputs(const OutputsConfig& config,
                                                        const std::shared_ptr<const Clock>& clock) {
  Opening opening{clock, {}, {}};
  for_each_output(config, [&opening](std::string_view key, const auto& output) {
    open_one(key, output, opening);
  });
  if (!opening.outcome) return pass(opening.outcome);
  return std::move(opening.sinks);
}

std::size_t slots_of_all(const OutputsConfig& config) {
  int smallest = outlet::kMaxSlots;
  bool any = false;
  for_each_output(config, [&](std::string_view /*key*/, const auto& output) {
    if (!output.common.enabled) return;
    smallest = std::min(smallest, output.common.max_persons);
    any = true;
  });
  return static_cast<std::size_t>(any ? smallest : OutputSetting{}.max_persons);
}

}  // namespace chorus::outputs
