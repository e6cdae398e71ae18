// chorus init: writes the configuration of a service, from options or from answers to questions.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/strong_id.h"
#include "common/client/discovery.h"
#include "common/client/service_client.h"
#include "common/net/host_name.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/new_file.h"
#include "services/ctl/setup/init_checks.h"
#include "services/ctl/setup/init_site.h"
#include "services/ctl/setup/phone_page.h"
#include "services/ctl/setup/written_certificates.h"
#include "services/ctl/setup/written_config.h"

namespace chorus::ctl {
namespace {

constexpr std::uint16_t kSensorPort = 8081;
constexpr std::uint16_t kFusionPort = 8080;
constexpr const char* kSensorFile = "/etc/chorus/sensor.json";
constexpr const char* kFolder = "/etc/chorus/";  // the units read their configurations there

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
  bool discover = false;
  std::string announce;  ///< A folder; see announce_folder.
  bool no_announce = false;
  std::string tls;  ///< A folder; see tls_folder.
  bool no_tls = false;
  AuthorityWishes authority;
  CertificateWishes certificate;
  InitSite site;
};

/// The name of this host as an id, in which characters that an id does not allow become "-"; "s1"
/// if that is no valid id.
std::string host_id() {
  std::string id = net::host_name();
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
    ask("Device: bridge, camera, phone, replay or simulated", arguments.sensor.device);
    if (arguments.sensor.device == "camera") ask("Camera", arguments.sensor.camera);
    if (arguments.sensor.device == "replay") ask("Recording to play", arguments.sensor.recording);
  } else {
    ask_many("A sensor, as ID=URL,TOKEN (its chorus init printed that)", arguments.sensors);
    ask_many("An output, as vrpn=ADDRESS or dtrack=ADDRESS:PORT", arguments.outputs);
  }
  ask("Listen on (127.0.0.1: this host alone)", arguments.address);
}

/// The folder of this host's certificate; empty: without TLS.
std::string tls_folder(const InitArguments& arguments) {
  if (arguments.no_tls) return {};
  if (!arguments.tls.empty()) return arguments.tls;
  return client::host_has_tls() ? client::kTlsFolder : "";
}

ServiceWishes service_wishes(const InitArguments& arguments, std::uint16_t port) {
  ServiceWishes wishes{
      arguments.address, arguments.port == 0 ? port : arguments.port, arguments.token, {}};
  wishes.tls = tls_folder(arguments);
  if (is_loopback(wishes.address)) return wishes;
  if (wishes.token.empty()) wishes.token = new_token();
  wishes.read_token = new_token();
  return wishes;
}

/// Writes a new file, readable by the owner and the service's group; never overwrites one.
Result<void> write_new(const std::string& file, const std::string& text) {
  return write_file(file, text, Readers::Services);
}

/// The host's name in addresses for others.
std::string shown_host(const std::string& tls) {
  const std::string own = net::host_name();
  const std::string name = tls.empty() ? own : certified_name(tls, own);
  if (name.empty()) return "HOST";
  return name.find(':') == std::string::npos ? name : "[" + name + "]";
}

void tell_next(const InitArguments& arguments, const ServiceWishes& wishes) {
  const std::string& service = arguments.service;
  const bool of_the_unit = arguments.out == kFolder + service + ".json";
  std::cerr << fmt::format("{} written.  Next:\n  {}\n", arguments.out,
                           of_the_unit
                               ? "systemctl restart chorus-" + service
                               : fmt::format("chorus-{} --config {}", service, arguments.out));
  std::cerr << certificate_note(wishes.tls);
  const std::string url =
      fmt::format("{}://{}:{}/", wishes.tls.empty() ? "http" : "https",
                  is_loopback(wishes.address) ? "127.0.0.1" : shown_host(wishes.tls), wishes.port);
  if (service == "sensor" && arguments.sensor.device == "phone") tell_phone(wishes, url);
  if (service == "sensor") {
    std::cerr << fmt::format("On the fusion host:\n  chorus init fusion --sensor {}={}{}{}\n",
                             arguments.sensor.id, url, wishes.read_token.empty() ? "" : ",",
                             wishes.read_token);
  } else {
    const std::string folder = std::filesystem::path(arguments.out).parent_path().string();
    std::cerr << "  chorus doctor"
              << (of_the_unit ? "" : " --folder " + (folder.empty() ? "." : folder)) << "\n  "
              << url << "viewer/ in a browser"
              << (wishes.token.empty() ? "\n" : ": any name, a token of the file as password\n");
  }
}

/// Where the announcement goes; empty: nowhere.  A configuration that is only shown, or written
/// elsewhere, is announced only on request.
std::string announce_folder(const InitArguments& arguments) {
  if (arguments.no_announce) return {};
  if (!arguments.announce.empty()) return arguments.announce;
  std::error_code hidden;
  const bool offered = arguments.out == kSensorFile && !is_loopback(arguments.address) &&
                       std::filesystem::is_directory(client::kAvahiFolder, hidden);
  return offered ? client::kAvahiFolder : "";
}

/// Writes the announcement.  A failure is only reported, because the sensor works without it.
void announce(const InitArguments& arguments, const ServiceWishes& wishes) {
  const std::string folder = announce_folder(arguments);
  if (folder.empty()) return;
  const std::string file = folder + "/chorus-sensor.service";
  const auto done =
      write_file(file, client::announcement(arguments.sensor.id, wishes.port, !wishes.tls.empty()),
                 Readers::Everybody, Overwriting::Yes);
  std::cerr << (done ? file + " written: chorus discover finds this sensor (--no-announce)\n"
                     : "note: not announced: " + to_string(done.error()) + "\n");
}

Result<ServiceWishes> write_sensor(InitArguments& arguments) {
  SensorWishes& wishes = arguments.sensor;
  if (const auto id = SensorId::parse(wishes.id); !id) return pass(id);
  constexpr std::array<std::string_view, 5> kDevices{"bridge", "camera", "phone", "replay",
                                                     "simulated"};
  if (std::ranges::find(kDevices, wishes.device) == kDevices.end()) {
    return fail(ErrorCode::InvalidArgument, "--device",
                "\"" + wishes.device + "\" is none of bridge, camera, phone, replay and simulated");
  }
  if (wishes.device == "replay" && wishes.recording.empty())
    return fail(ErrorCode::InvalidArgument, "--recording", "a replay needs the file to play");
  wishes.socket = push_socket(wishes.id, arguments.out == kSensorFile, own_environment());
  wishes.service = service_wishes(arguments, kSensorPort);
  if (auto ok = write_new(arguments.out, sensor_config(wishes)); !ok) return pass(ok);
  announce(arguments, wishes.service);
  return wishes.service;
}

/// Adds the sensors that announce themselves, except those whose name is already in the list.
Result<void> add_discovered(std::vector<PolledWish>& sensors) {
  const auto found = client::discovered_sensors();
  if (!found) return pass(found);
  const std::vector<PolledWish> named = sensors;
  for (const client::FoundSensor& sensor : *found) {
    const auto of_this = [&](const auto& each) { return each.id == sensor.id; };
    if (std::ranges::any_of(named, of_this)) continue;
    // If two services announce one id, either may be an impostor that wants the token, so a person
    // has to choose.
    if (std::ranges::count_if(*found, of_this) > 1)
      return fail(ErrorCode::Conflict, sensor.id,
                  "is announced more than once (chorus discover): name it with --sensor");
    sensors.push_back({sensor.id, sensor.url(), ""});
    std::cerr << "found " << sensor.id << " at " << sensor.url()
              << "; its token is not announced: chorus init printed it there\n";
  }
  return {};
}

/// Reads lines "ID=URL,TOKEN" from a file, so that no token shows up in the list of processes.
Result<void> read_sensors(const std::string& file, std::vector<std::string>& out) {
  std::ifstream named;
  if (file != "-") named.open(file);
  std::istream& lines = file == "-" ? std::cin : named;
  if (!lines)
    return fail(ErrorCode::Io, file, "cannot be read; a line a sensor, ID=URL,TOKEN; -: our input");
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
  if (arguments.discover) {
    if (auto ok = add_discovered(wishes.sensors); !ok) return pass(ok);
  }
  for (const std::string& text : arguments.outputs) {
    const auto output = output_wish(text);
    if (!output) return pass(output);
    wishes.outputs.push_back(*output);
  }
  if (auto ok = check_names(wishes.sensors); !ok) return pass(ok);
  wishes.service = service_wishes(arguments, kFusionPort);
  if (auto ok = write_new(arguments.out, fusion_config(wishes)); !ok) return pass(ok);
  return wishes.service;
}

Result<int> run_init_ca(const InitArguments& arguments) {
  AuthorityWishes wishes = arguments.authority;
  if (!arguments.out.empty()) wishes.folder = arguments.out;
  if (auto ok = write_authority(wishes); !ok) return pass(ok);
  std::cerr << fmt::format(
      "{0}/ca.crt and {0}/ca.key written.  Who has ca.key can stand in for every host: keep it "
      "here.\nGive ca.crt to browsers and programs.  Next, for each host:\n  {1}\n",
      wishes.folder, next_certificate(wishes.folder));
  return kExitOk;
}

Result<int> run_init_certificate(const InitArguments& arguments) {
  CertificateWishes wishes = arguments.certificate;
  if (!arguments.out.empty()) wishes.folder = arguments.out;
  if (auto ok = write_certificate(wishes); !ok) return pass(ok);
  std::cerr << fmt::format(
      "{0}/host.crt, host.key and ca.crt written.  Where they are in {1}, chorus init makes "
      "services that use them;\na service that has them: systemctl reload chorus-SERVICE.\n",
      wishes.folder, client::kTlsFolder);
  return kExitOk;
}

/// With what other services take from the same options.
InitSite site_of(const InitArguments& arguments) {
  InitSite site = arguments.site;
  site.wishes.name = arguments.authority.name;
  site.wishes.listen = arguments.address;
  site.wishes.tls = tls_folder(arguments);
  if (arguments.port != 0) site.wishes.port = arguments.port;
  if (site.wishes.address.empty()) site.wishes.address = shown_host(site.wishes.tls);
  return site;
}

Result<int> run_init(InitArguments& arguments) {
  if (arguments.service == "ca") return run_init_ca(arguments);
  if (arguments.service == "certificate") return run_init_certificate(arguments);
  if (arguments.service == "site") return run_init_site(site_of(arguments), arguments.out);
  if (!arguments.certificate.hosts.empty()) {
    return fail(ErrorCode::InvalidArgument, arguments.certificate.hosts.front(),
                "is not understood after \"" + arguments.service + "\"; see chorus init --help");
  }
  if (arguments.out.empty()) arguments.out = kFolder + arguments.service + ".json";
  if (arguments.sensor.id.empty()) arguments.sensor.id = host_id();
  if (arguments.ask) ask_for(arguments);
  if (auto ok = check_service(arguments.address, arguments.token); !ok) return pass(ok);
  const auto wishes =
      arguments.service == "sensor" ? write_sensor(arguments) : write_fusion(arguments);
  if (!wishes) return pass(wishes);
  if (arguments.out != "-") tell_next(arguments, *wishes);
  return kExitOk;
}

void add_discovery_options(CLI::App& options, InitArguments& arguments) {
  options.add_flag("--discover", arguments.discover,
                   "fusion: also the sensors that announce themselves (chorus discover)");
  options
      .add_option("--announce", arguments.announce,
                  "sensor: folder for the file that has Avahi announce it; default: "
                  "/etc/avahi/services if it is there, unless only this host is listened to")
      ->excludes(
          options.add_flag("--no-announce", arguments.no_announce, "sensor: writes no such file"));
}

void add_tls_options(CLI::App& options, InitArguments& arguments) {
  options
      .add_option(
          "--tls", arguments.tls,
          "Folder of host.crt, host.key and ca.crt; default: /etc/chorus/tls if it has them")
      ->excludes(options.add_flag("--no-tls", arguments.no_tls, "Speak http without TLS"));
  CertificateWishes& certificate = arguments.certificate;
  options.add_option("hosts", certificate.hosts,
                     "certificate: names and addresses; default: this host's name");
  options.add_option("--authority", certificate.authority, "certificate: the folder of `init ca`")
      ->capture_default_str();
  options.add_flag("--renew", certificate.renew, "certificate: replaces the one that is there");
  options.add_option("--name", arguments.authority.name,
                     "ca: what browsers call it; site: the hall's name");
  constexpr int kLongest = 36500;
  options
      .add_option_function<int>(
          "--days",
          [&arguments](int days) { arguments.authority.days = arguments.certificate.days = days; },
          "ca, certificate: good for so long; default: 3650, 800")
      ->check(CLI::Range(1, kLongest));
}

void add_sensor_options(CLI::App& options, InitArguments& arguments) {
  options.add_option("--id", arguments.sensor.id, "sensor: its id; default: the host's name");
  options
      .add_option("--device", arguments.sensor.device,
                  "sensor: bridge, camera, phone, replay or simulated")
      ->capture_default_str();
  options
      .add_option("--camera", arguments.sensor.camera,
                  "sensor: a webcam, rtsp://... or a video file")
      ->capture_default_str();
  options.add_option("--recording", arguments.sensor.recording, "sensor: what a replay plays");
  options.add_flag("--images", arguments.sensor.images, "sensor: serve pictures");
}

void add_fusion_options(CLI::App& options, InitArguments& arguments) {
  options
      .add_option("--sensor", arguments.sensors, "fusion: ID=URL or ID=URL,TOKEN; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  options.add_option("--sensors-from", arguments.sensors_from,
                     "fusion: a file with a sensor a line, as for --sensor; -: standard input");
  options
      .add_option("--output", arguments.outputs,
                  "fusion: vrpn=CLIENT,..., dtrack=HOST:PORT, ...; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
}

}  // namespace

Run add_init(CLI::App& options) {
  const auto arguments = std::make_shared<InitArguments>();
  options
      .add_option("service", arguments->service,
                  "sensor, fusion, ca (an authority of one's own), certificate or site")
      ->required()
      ->check(CLI::IsMember({"sensor", "fusion", "ca", "certificate", "site"}));
  options.add_option(
      "--out", arguments->out,
      "File; default: /etc/chorus/SERVICE.json; -: standard output; ca, "
      "certificate, site: a folder, default /etc/chorus/ca, /etc/chorus/tls, /etc/chorus/site");
  options.add_flag("--ask", arguments->ask, "Ask for what matters");
  options.add_option("--listen", arguments->address, "Address; 127.0.0.1: this host alone")
      ->capture_default_str();
  options
      .add_option("--port", arguments->port, "Port; default: sensor 8081, fusion 8080, site 4222")
      ->check(CLI::Range(1, 65535));
  options.add_option(
      "--token", arguments->token,
      "Token of role control; default: a new one, unless only this host is listened to");
  add_sensor_options(options, *arguments);
  add_fusion_options(options, *arguments);
  add_discovery_options(options, *arguments);
  add_tls_options(options, *arguments);
  add_site_options(options, arguments->site);
  return [arguments] { return told_as_usage("chorus init", run_init(*arguments)); };
}

}  // namespace chorus::ctl
