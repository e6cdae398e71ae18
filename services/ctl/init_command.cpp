// chorus init: writes the configuration of a service, from options or from answers to questions.
#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/strong_id.h"
#include "services/ctl/command.h"
#include "services/ctl/written_config.h"

namespace chorus::ctl {
namespace {

constexpr std::uint16_t kSensorPort = 8081;
constexpr std::uint16_t kFusionPort = 8080;

struct InitArguments {
  std::string service;
  std::string out;
  bool ask = false;
  std::string address = "0.0.0.0";
  std::uint16_t port = 0;
  std::string token;
  SensorWishes sensor;
  std::vector<std::string> sensors;
  std::string sensors_from;
  std::vector<std::string> outputs;
};

/// The name of this host as an id; characters that an id does not allow become "-".
std::string host_id() {
  std::array<char, 65> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "s1";
  std::string id(name.data());
  id = id.substr(0, id.find('.'));
  std::replace_if(
      id.begin(), id.end(),
      [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; }, '-');
  return SensorId::parse(id) ? id : "s1";
}

/// Asks one question on the terminal; an empty line keeps the present value.
void ask(const std::string& question, std::string& value) {
  std::cerr << question << " [" << value << "]: " << std::flush;
  std::string line;
  if (std::getline(std::cin, line) && !line.empty()) value = line;
}

void ask_many(const std::string& question, std::vector<std::string>& values) {
  while (true) {
    std::string line;
    ask(question + ", empty: no more", line);
    if (line.empty()) return;
    values.push_back(line);
  }
}

void ask_for(InitArguments& arguments) {
  if (arguments.service == "sensor") {
    ask("Name of this sensor, unique in the workshop", arguments.sensor.id);
    ask("Device: bridge, camera, replay or simulated", arguments.sensor.device);
    if (arguments.sensor.device == "camera") ask("Camera", arguments.sensor.camera);
    if (arguments.sensor.device == "replay") ask("Recording to play", arguments.sensor.recording);
  } else {
    ask_many("A sensor, as ID=URL,TOKEN (its chorus init printed that)", arguments.sensors);
    ask_many("An output, as vrpn=ADDRESS or dtrack=ADDRESS:PORT", arguments.outputs);
  }
  ask("Listen on (127.0.0.1: this host alone)", arguments.address);
}

bool is_loopback(const std::string& address) {
  return address.starts_with("127.") || address == "::1" || address == "localhost";
}

ServiceWishes service_wishes(const InitArguments& arguments, std::uint16_t port) {
  ServiceWishes wishes{
      arguments.address, arguments.port == 0 ? port : arguments.port, arguments.token, {}};
  if (is_loopback(wishes.address)) return wishes;
  if (wishes.token.empty()) wishes.token = new_token();
  wishes.read_token = new_token();
  return wishes;
}

/// Writes a new file, readable by the owner and the service's group; never overwrites one.
Result<void> write_new(const std::string& file, const std::string& text) {
  if (file == "-") {
    std::cout << text;
    return {};
  }
  constexpr mode_t kOwnerAndGroup = 0640;
  const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kOwnerAndGroup);
  if (made < 0 && errno == EEXIST) {
    return fail(ErrorCode::InvalidArgument, file,
                "exists and is not overwritten: edit it, move it away, or give --out FILE");
  }
  if (made < 0) {
    return fail(ErrorCode::Io, file,
                std::string("cannot be written: ") + std::strerror(errno) +
                    " (as root, or with --out FILE)");
  }
  const group* const services = ::getgrnam("chorus");
  const bool handed =
      services == nullptr || ::geteuid() != 0 || ::fchown(made, 0, services->gr_gid) == 0;
  const bool written = ::write(made, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  ::close(made);
  if (handed && written) return {};
  ::unlink(file.c_str());
  return fail(ErrorCode::Io, file, std::string("cannot be written: ") + std::strerror(errno));
}

std::string shown_host() {
  std::array<char, 65> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "HOST";
}

void tell_next(const InitArguments& arguments, const ServiceWishes& wishes) {
  const std::string& service = arguments.service;
  std::cerr << fmt::format("{} written.  Next:\n  systemctl restart chorus-{}\n", arguments.out,
                           service);
  const std::string url = fmt::format(
      "http://{}:{}/", is_loopback(wishes.address) ? "127.0.0.1" : shown_host(), wishes.port);
  if (service == "sensor") {
    std::cerr << fmt::format("On the fusion host:\n  chorus init fusion --sensor {}={}{}{}\n",
                             arguments.sensor.id, url, wishes.read_token.empty() ? "" : ",",
                             wishes.read_token);
  } else {
    std::cerr << "  chorus doctor\n  " << url << "viewer/ in a browser"
              << (wishes.token.empty() ? "\n" : ": any name, a token of the file as password\n");
  }
}

Result<ServiceWishes> write_sensor(InitArguments& arguments) {
  SensorWishes& wishes = arguments.sensor;
  if (const auto id = SensorId::parse(wishes.id); !id) return pass(id);
  constexpr std::array<std::string_view, 4> kDevices{"bridge", "camera", "replay", "simulated"};
  if (std::ranges::find(kDevices, wishes.device) == kDevices.end()) {
    return fail(ErrorCode::InvalidArgument, "--device",
                "\"" + wishes.device + "\" is none of bridge, camera, replay and simulated");
  }
  if (wishes.device == "replay" && wishes.recording.empty())
    return fail(ErrorCode::InvalidArgument, "--recording", "a replay needs the file to play");
  wishes.service = service_wishes(arguments, kSensorPort);
  if (auto ok = write_new(arguments.out, sensor_config(wishes)); !ok) return pass(ok);
  return wishes.service;
}

/// Reads lines "ID=URL,TOKEN" from a file, so that no token shows up in the list of processes.
Result<void> read_sensors(const std::string& file, std::vector<std::string>& out) {
  std::ifstream named;
  if (file != "-") named.open(file);
  std::istream& lines = file == "-" ? std::cin : named;
  if (!lines) return fail(ErrorCode::Io, file, "cannot be read");
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) out.push_back(line);
  }
  return {};
}

Result<ServiceWishes> write_fusion(InitArguments& arguments) {
  FusionWishes wishes;
  if (!arguments.sensors_from.empty()) {
    if (auto ok = read_sensors(arguments.sensors_from, arguments.sensors); !ok) return pass(ok);
  }
  for (const std::string& text : arguments.sensors) {
    const auto sensor = polled_wish(text);
    if (!sensor) return pass(sensor);
    wishes.sensors.push_back(*sensor);
  }
  for (const std::string& text : arguments.outputs) {
    const auto output = output_wish(text);
    if (!output) return pass(output);
    wishes.outputs.push_back(*output);
  }
  wishes.service = service_wishes(arguments, kFusionPort);
  if (auto ok = write_new(arguments.out, fusion_config(wishes)); !ok) return pass(ok);
  return wishes.service;
}

Result<int> run_init(InitArguments& arguments) {
  if (arguments.out.empty()) arguments.out = "/etc/chorus/" + arguments.service + ".json";
  if (arguments.sensor.id.empty()) arguments.sensor.id = host_id();
  if (arguments.ask) ask_for(arguments);
  const auto wishes =
      arguments.service == "sensor" ? write_sensor(arguments) : write_fusion(arguments);
  if (!wishes) return pass(wishes);
  if (arguments.out != "-") tell_next(arguments, *wishes);
  return kExitOk;
}

}  // namespace

Run add_init(CLI::App& options) {
  const auto arguments = std::make_shared<InitArguments>();
  options.add_option("service", arguments->service, "sensor or fusion")
      ->required()
      ->check(CLI::IsMember({"sensor", "fusion"}));
  options.add_option("--out", arguments->out,
                     "File; default: /etc/chorus/SERVICE.json; -: standard output");
  options.add_flag("--ask", arguments->ask, "Ask for what matters");
  options.add_option("--listen", arguments->address, "Address; 127.0.0.1: this host alone")
      ->capture_default_str();
  options
      .add_option("--port", arguments->port, "Port; default: 8081 for a sensor, 8080 for fusion")
      ->check(CLI::Range(1, 65535));
  options.add_option(
      "--token", arguments->token,
      "Token of role control; default: a new one, unless only this host is listened to");
  options.add_option("--id", arguments->sensor.id, "sensor: its id; default: the host's name");
  options
      .add_option("--device", arguments->sensor.device,
                  "sensor: bridge, camera, replay or simulated")
      ->capture_default_str();
  options
      .add_option("--camera", arguments->sensor.camera,
                  "sensor: a webcam, rtsp://... or a video file")
      ->capture_default_str();
  options.add_option("--recording", arguments->sensor.recording, "sensor: what a replay plays");
  options.add_flag("--images", arguments->sensor.images, "sensor: serve pictures");
  options
      .add_option("--sensor", arguments->sensors, "fusion: ID=URL or ID=URL,TOKEN; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  options.add_option("--sensors-from", arguments->sensors_from,
                     "fusion: a file with a sensor a line, as for --sensor; -: standard input");
  options
      .add_option("--output", arguments->outputs,
                  "fusion: vrpn=CLIENT,..., dtrack=HOST:PORT, ...; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  return [arguments] { return run_init(*arguments); };
}

}  // namespace chorus::ctl
