#include "fusion-server/outputs/outputs.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
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
  visit("mqtt", config.mqtt);
}

/// open_outlet() is found in the protocol's namespace, by argument-dependent lookup.
template <class Setting>
Result<std::unique_ptr<Sink>> open_one(std::string_view key, const Setting& output,
                                       const OutputsContext& given) {
  outlet::OutletContext context{
      static_cast<std::size_t>(output.common.max_persons), given.clock, {}};
  if (given.board)
    for (const workplace::Prop& prop : given.board->props()) context.props.push_back(prop.name);
  auto outlet = open_outlet(output.protocol, context);
  if (!outlet) {
    Error error = outlet.error();
    error.context = "outputs." + std::string(key) + ": " + error.context;
    return tl::unexpected<Error>(std::move(error));
  }
  return std::make_unique<outlet::OutletSink>(
      std::move(*outlet),
      outlet::OutletTiming{output.common.latency, context.slots, context.clock, given.board});
}

/// Calls `visit` with the key and the settings of the output with this index, and returns what it
/// returns.
template <class Value, class Config, class Visitor>
Value of_output(Config& config, std::size_t index, Value otherwise, const Visitor& visit) {
  std::size_t at = 0;
  for_each_output(config, [&](std::string_view key, auto& output) {
    if (at++ == index) otherwise = visit(key, output);
  });
  return otherwise;
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
                                                        const OutputsContext& context) {
  std::vector<std::unique_ptr<Sink>> sinks;
  for (std::size_t i = 0; i < output_names().size(); ++i) {
    if (!is_enabled(config, i)) continue;
    auto sink = open_output(config, i, context);
    if (!sink) return pass(sink);
    sinks.push_back(std::move(*sink));
  }
  return sinks;
}

const std::vector<std::string_view>& output_names() {
  static const auto names = [] {
    std::vector<std::string_view> all;
    const OutputsConfig config;
    for_each_output(config, [&](std::string_view key, const auto&) { all.push_back(key); });
    return all;
  }();
  return names;
}

bool is_enabled(const OutputsConfig& config, std::size_t index) {
  return of_output(config, index, false,
                   [](std::string_view, const auto& output) { return output.common.enabled; });
}

bool same_output(const OutputsConfig& a, const OutputsConfig& b, std::size_t index) {
  // Copies in which all other outputs are the same: then the configurations compare as this one.
  OutputsConfig left;
  OutputsConfig right;
  const auto copy = [index](const OutputsConfig& from, OutputsConfig& to) {
    std::size_t at = 0;
    for_each_output(from, [&](std::string_view key, const auto& output) {
      if (at++ != index) return;
      for_each_output(to, [&](std::string_view other, auto& target) {
        if constexpr (std::is_same_v<std::decay_t<decltype(target)>,
                                     std::decay_t<decltype(output)>>) {
          if (other == key) target = output;
        }
      });
    });
  };
  copy(a, left);
  copy(b, right);
  return left == right;
}

Result<std::unique_ptr<Sink>> open_output(const OutputsConfig& config, std::size_t index,
                                          const OutputsContext& context) {
  std::optional<Result<std::unique_ptr<Sink>>> opened;
  std::size_t at = 0;
  for_each_output(config, [&](std::string_view key, const auto& output) {
    if (at++ == index) opened = open_one(key, output, context);
  });
  if (!opened) return fail(ErrorCode::NotFound, "outputs", "there is no such output");
  return std::move(*opened);
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
