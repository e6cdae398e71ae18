#include "services/ctl/setup/written_config.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "common/base/parse.h"
#include "common/base/strong_id.h"
#include "common/http/client.h"
#include "common/net/allow_list.h"

namespace chorus::ctl {
namespace {

/// How clients get an output's data.
enum class Manner { Serves, Sends, Publishes, Shares };
struct KnownOutput {
  std::string_view name;
  Manner manner;
  std::string_view comment;
};
constexpr std::array kOutputs{
    KnownOutput{"vrpn", Manner::Serves, "VRPN, port 3883 (TCP and UDP)"},
    KnownOutput{"natnet", Manner::Serves, "OptiTrack NatNet, port 1510 (UDP)"},
    KnownOutput{"dtrack", Manner::Sends, "A.R.T. DTrack, ASCII over UDP"},
    KnownOutput{"mxtp", Manner::Sends, "Xsens MVN network streaming"},
    KnownOutput{"vmc", Manner::Sends, "VMC protocol (OSC)"},
    KnownOutput{"vrchat", Manner::Sends, "VRChat OSC trackers"},
    KnownOutput{"mqtt", Manner::Publishes, "MQTT 3.1.1, people as JSON to a broker"},
    KnownOutput{"trackd", Manner::Shares, "trackd / CAVELib shared memory of this host"}};

const KnownOutput* known(std::string_view name) {
  const auto* const found = std::find_if(kOutputs.begin(), kOutputs.end(),
                                         [&](const KnownOutput& o) { return o.name == name; });
  return found == kOutputs.end() ? nullptr : found;
}

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

std::string list(const std::vector<std::string>& texts) {
  std::vector<std::string> all;
  for (const std::string& text : texts) all.push_back(quoted(text));
  return fmt::format("[{}]", fmt::join(all, ", "));
}

std::string heading(std::string_view program, std::string_view example) {
  return fmt::format(
      "// {0}, written by chorus init.  Every other key and its default: "
      "/usr/share/doc/{0}/examples/{1}\n"
      "// Try a change: {0} --check --config FILE.  Take it over: systemctl reload {0} (keys "
      "marked "
      "(restart) there: restart).\n",
      program, example);
}

std::string tokens_of(const ServiceWishes& wishes) {
  std::vector<std::string> rows;
  const auto add = [&rows](const std::string& token, const char* role) {
    if (!token.empty())
      rows.push_back(
          fmt::format("\n      {{ \"token\": {}, \"role\": \"{}\" }}", quoted(token), role));
  };
  add(wishes.token, "control");
  add(wishes.read_token, "read");
  if (rows.empty()) return {};
  return fmt::format(
      ",\n"
      "    // Who may do what: \"read\" frames and states; \"images\" also pictures and "
      "recordings; "
      "\"control\" everything.\n"
      "    // Sent as \"Authorization: Bearer TOKEN\".  Who knows one is let in: keep this file "
      "from "
      "others.\n"
      "    \"tokens\": [{}\n    ]",
      fmt::join(rows, ","));
}

std::string tls_of(const std::string& folder) {
  if (folder.empty()) return {};
  return fmt::format(
      ",\n"
      "    // https only.  A reload takes a renewed certificate over (chorus init certificate "
      "--renew).\n"
      "    \"tls\": {{ \"certificate\": {}, \"key\": {} }}",
      quoted(folder + "/host.crt"), quoted(folder + "/host.key"));
}

std::string http_of(const ServiceWishes& wishes) {
  return fmt::format(
      "  \"http\": {{\n"
      "    // Where it listens: 127.0.0.1 is this host alone, 0.0.0.0 the whole network (then with "
      "tokens).\n"
      "    \"address\": {},\n"
      "    \"port\": {}{}{}\n"
      "  }},\n\n",
      quoted(wishes.address), wishes.port, tls_of(wishes.tls), tokens_of(wishes));
}

/// s1 gets the first place on a ring of six, s2 the second, and so on: the simulated sensors of one
/// workshop then see the same person from different sides.  Where the id has no number, the port
/// tells those of one host apart.
std::size_t ring_place_of(const std::string& id, int port) {
  constexpr std::size_t kPlaces = 6;
  constexpr int kUsualPort = 8081;
  const std::size_t digits = id.find_last_not_of("0123456789") + 1;
  const auto number = parse_number<std::size_t>(std::string_view(id).substr(digits));
  if (number) return (*number + kPlaces - 1) % kPlaces;
  return static_cast<std::size_t>(std::max(0, port - kUsualPort)) % kPlaces;
}

/// The device's own section of the configuration, which follows `kind`.
std::string section_of(const SensorWishes& wishes) {
  if (wishes.device == "phone") {
    return "    // Serves /capture/, a page that makes the camera of a phone or laptop this "
           "sensor.\n"
           "    \"bridge\": { \"label\": \"phone\", \"page\": true }";
  }
  if (wishes.device == "bridge") {
    return "    // Programs of this host that may open this socket push without a token.\n"
           "    \"bridge\": { \"socket\": " +
           quoted(wishes.socket) + " }";
  }
  if (wishes.device == "camera") {
    return "    // A webcam (chorus camera list shows them), a stream (rtsp://...) or a video "
           "file.\n"
           "    \"camera\": { \"source\": " +
           quoted(wishes.camera) + " }";
  }
  if (wishes.device == "simulated") {
    return fmt::format(
        "    // Where it stands among six around the room.\n"
        "    \"simulated\": {{ \"ring\": {{ \"index\": {} }} }}",
        ring_place_of(wishes.id, wishes.service.port));
  }
  return "    \"replay\": { \"recording\": " + quoted(wishes.recording) + " }";
}

std::string device_of(const SensorWishes& wishes) {
  return "  // bridge: a program, or a phone's page, pushes frames to /push; camera: people are "
         "found in pictures;\n"
         "  // replay: plays a recording; simulated: a person who is not there.\n"
         "  \"device\": {\n    \"kind\": " +
         quoted(wishes.device == "phone" ? "bridge" : wishes.device) + ",\n" + section_of(wishes) +
         "\n  }\n";
}

std::string sensors_of(const std::vector<PolledWish>& sensors) {
  std::vector<std::string> rows;
  for (const PolledWish& sensor : sensors) {
    const std::string token =
        sensor.token.empty() ? "" : fmt::format(", \"token\": {}", quoted(sensor.token));
    rows.push_back(fmt::format("\n    {{ \"id\": {}, \"url\": {}{} }}", quoted(sensor.id),
                               quoted(sensor.url), token));
  }
  return fmt::format(
      "  // The sensors to read; \"token\" is one of the sensor's own, with role read or more.\n"
      "  \"sensors\": [{}\n  ],\n\n",
      fmt::join(rows, ","));
}

std::string poll_of(const FusionWishes& wishes) {
  const bool secure = std::any_of(wishes.sensors.begin(), wishes.sensors.end(),
                                  [](const auto& s) { return s.url.starts_with("https:"); });
  if (!secure || wishes.service.tls.empty()) return {};
  return fmt::format(
      "  // Who vouches for the sensors.\n"
      "  \"poll\": {{ \"ca\": {} }},\n\n",
      quoted(wishes.service.tls + "/ca.crt"));
}

std::string output_text(const OutputWish& wish) {
  const KnownOutput& output = *known(wish.name);
  std::string keys;
  if (output.manner == Manner::Serves) {
    keys = fmt::format(", \"address\": \"0.0.0.0\", \"allow\": {}", list(wish.peers));
  } else if (output.manner == Manner::Sends) {
    keys = fmt::format(", \"targets\": {}", list(wish.peers));
  } else if (output.manner == Manner::Publishes) {
    const std::string& broker = wish.peers.front();
    const std::size_t colon = broker.rfind(':');
    keys = fmt::format(", \"server\": {}, \"port\": {}", quoted(broker.substr(0, colon)),
                       broker.substr(colon + 1));
  }
  return fmt::format("\n    // {}\n    {}: {{ \"enabled\": true{} }}", output.comment,
                     quoted(wish.name), keys);
}

std::string outputs_of(const std::vector<OutputWish>& outputs) {
  std::vector<std::string> rows;
  for (const OutputWish& wish : outputs) rows.push_back(output_text(wish));
  if (rows.empty()) return {};
  return fmt::format(
      "  // The tracker in other protocols.  \"allow\": the only addresses that are answered.\n"
      "  \"outputs\": {{{}\n  }},\n\n",
      fmt::join(rows, ","));
}

std::vector<std::string> parts_of(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

bool has_port(std::string_view target) {
  const std::size_t colon = target.rfind(':');
  if (colon == std::string_view::npos || colon == 0) return false;
  const auto port = parse_number<int>(target.substr(colon + 1));
  constexpr int kHighest = 65535;
  return port && *port >= 1 && *port <= kHighest;
}

}  // namespace

Result<PolledWish> polled_wish(std::string_view text) {
  const auto refuse = [&](const std::string& why) {
    return fail(
        ErrorCode::InvalidArgument, std::string(text),
        why + "; write a sensor as ID=URL or ID=URL,TOKEN, such as s1=http://10.0.0.11:8081/");
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return refuse("has no URL");
  PolledWish wish{std::string(text.substr(0, equals)), {}, {}};
  const std::string_view rest = text.substr(equals + 1);
  const std::size_t comma = std::min(rest.find(','), rest.size());
  wish.url = rest.substr(0, comma);
  wish.token = rest.substr(std::min(comma + 1, rest.size()));
  if (const auto id = SensorId::parse(wish.id); !id) return refuse(id.error().message);
  if (const auto url = http::parse_url(wish.url); !url) return refuse(url.error().message);
  if (wish.token == "TOKEN")
    return refuse("TOKEN stands for one that chorus init printed on the sensor's host");
  return wish;
}

Result<OutputWish> output_wish(std::string_view text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  OutputWish wish{std::string(text.substr(0, equals)),
                  parts_of(text.substr(std::min(equals + 1, text.size())), ',')};
  const KnownOutput* const output = known(wish.name);
  if (output == nullptr) {
    return fail(ErrorCode::InvalidArgument, wish.name,
                "is no output; there are vrpn, natnet, dtrack, mxtp, vmc, vrchat, mqtt and trackd");
  }
  if (wish.peers.empty() && output->manner == Manner::Serves) {
    return fail(ErrorCode::InvalidArgument, wish.name,
                "say who may connect: " + wish.name + "=10.0.0.20,10.0.0.21");
  }
  if (output->manner == Manner::Serves) {
    if (const auto list = net::AllowList::parse(wish.peers); !list) return pass(list);
  }
  const bool sends = output->manner == Manner::Sends || output->manner == Manner::Publishes;
  if (output->manner == Manner::Publishes && wish.peers.size() > 1) {
    return fail(ErrorCode::InvalidArgument, wish.name, "name one broker, HOST:PORT");
  }
  if (wish.peers.empty() && sends) {
    return fail(ErrorCode::InvalidArgument, wish.name,
                "say where to send: " + wish.name + "=10.0.0.20:PORT");
  }
  for (const std::string& peer : wish.peers) {
    if (sends && !has_port(peer)) {
      return fail(ErrorCode::InvalidArgument, wish.name,
                  "\"" + peer + "\" names no port: write " + wish.name + "=" + peer + ":PORT");
    }
  }
  return wish;
}

std::string push_socket(const std::string& id, bool of_the_unit, const Environment& environment) {
  namespace fs = std::filesystem;
  if (of_the_unit) return "/run/chorus-sensor/push";
  const fs::path run = value_of(environment, "XDG_RUNTIME_DIR");
  std::error_code unknown;
  const bool usable = run.is_absolute() && fs::is_directory(run, unknown);
  return ((usable ? run : fs::path("/tmp")) / ("chorus-" + id + ".push")).string();
}

std::string sensor_config(const SensorWishes& wishes) {
  return heading("chorus-sensor", "sensor.json") + "{\n" +
         fmt::format(
             "  // Names the sensor in every frame; unique in the workshop. (restart)\n  \"id\": "
             "{},\n\n",
             quoted(wishes.id)) +
         http_of(wishes.service) +
         fmt::format(
             "  // Serve pictures.  They show people: leave this off unless everybody has agreed.\n"
             "  \"images\": {},\n\n",
             wishes.images) +
         "  // POST /recordings/ starts a recording here. (restart)\n"
         "  \"recording\": { \"folder\": \"/var/lib/chorus/sensor/recordings\" },\n\n" +
         device_of(wishes) + "}\n";
}

std::string fusion_config(const FusionWishes& wishes) {
  return heading("chorus-fusion", "fusion.json") + "{\n" + http_of(wishes.service) +
         sensors_of(wishes.sensors) + poll_of(wishes) + outputs_of(wishes.outputs) +
         "  // POST /recordings/ starts a recording here. (restart)\n"
         "  \"recording\": { \"folder\": \"/var/lib/chorus/fusion/recordings\" },\n\n"
         "  // Where the sensors stand is kept here over restarts. (restart)\n"
         "  \"state_dir\": \"/var/lib/chorus/fusion\",\n\n"
         "  \"viewer_dir\": \"/usr/share/chorus/viewer\"\n}\n";
}

std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getentropy(bytes.data(), bytes.size()) != 0)
    throw std::runtime_error("the system has no random numbers");
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

}  // namespace chorus::ctl
