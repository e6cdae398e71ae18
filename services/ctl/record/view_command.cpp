// chorus view: the cockpit on a recording, in a browser or as one picture.
#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <regex>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/asked_program.h"
#include "common/base/file.h"
#include "common/http/server.h"
#include "common/record/recording_files.h"
#include "common/resource/link_lines.h"
#include "common/service/recording_views.h"
#include "common/service/signals.h"
#include "fusion-server/server/state_folder.h"
#include "services/ctl/convert/sniffed.h"
#include "services/ctl/line/command.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

struct ViewArguments {
  std::vector<std::string> inputs;
  int port = 0;
  std::string png;  ///< "t=12.4" or "12.4"; empty: a browser.
  std::string out;
  std::string size = "1280x720";
};

/// The name under which the recording is shown: that of its file or folder.
std::string name_of(const std::vector<fs::path>& inputs) {
  fs::path first = inputs.front();
  if (first.filename().empty()) first = first.parent_path();
  std::string name = first.extension() == ".mcap" ? first.stem() : first.filename();
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_') c = '-';
  return name.empty() ? "recording" : name.substr(0, 64);
}

/// A server of this recording and of the page alone.
struct Show {
  std::string name;
  std::shared_ptr<service::RecordingViews> views;
  std::unique_ptr<http::Server> server;

  [[nodiscard]] std::string url(const std::string& more = {}) const {
    return fmt::format("http://127.0.0.1:{}/viewer/?recording={}&only{}", server->port(), name,
                       more);
  }
};

http::DocumentPtr list_of(const std::string& name) {
  const nlohmann::json all{{"recordings", {{{"name", name}, {"state", "finished"}}}}};
  http::DocumentOptions options;
  options.version = "1";
  return resource::other_document("application/json", all.dump() + "\n", std::move(options));
}

Result<Show> show_of(const ViewArguments& arguments, const std::vector<fs::path>& files) {
  const std::string viewer = server::viewer_folder("auto");
  if (auto there = server::probe_viewer(viewer); !there) return pass(there);
  Show show;
  show.name = name_of({arguments.inputs.begin(), arguments.inputs.end()});
  service::RecordingViewsOptions options;
  options.files_of = [name = show.name,
                      files](const std::string& asked) -> Result<std::vector<fs::path>> {
    if (asked == name) return files;
    return fail(ErrorCode::NotFound, "recordings/" + asked, "only " + name + " is shown here");
  };
  options.run = "view";
  show.views = std::make_shared<service::RecordingViews>(std::move(options));
  auto router = std::make_shared<http::Router>();
  show.views->add_routes(*router);
  router->get("/recordings/", [document = list_of(show.name)](const auto&, const auto&) {
    return Result<http::DocumentPtr>(document);
  });
  router->files("/viewer/", viewer,
                {resource::link_lines(resource::Kind::Other), http::Page::Viewer});
  http::ServerConfig config;
  config.port = static_cast<std::uint16_t>(arguments.port);
  config.policy = resource::answer_policy();
  show.server = std::make_unique<http::Server>(config, std::move(router));
  if (auto bound = show.server->start(); !bound) return pass(bound);
  return show;
}

/// The browser's own words are many; they are shown only when there is no picture.
Result<int> take_picture(const Show& show, const ViewArguments& arguments) {
  static const std::regex kInstant("(?:t=)?([0-9]+(?:\\.[0-9]+)?)");
  static const std::regex kSize("([1-9][0-9]{1,4})x([1-9][0-9]{1,4})");
  std::smatch instant;
  std::smatch size;
  if (!std::regex_match(arguments.png, instant, kInstant))
    return fail(ErrorCode::InvalidArgument, "--png",
                "is an instant in seconds, as in --png t=12.4");
  if (!std::regex_match(arguments.size, size, kSize))
    return fail(ErrorCode::InvalidArgument, "--size", "is WIDTHxHEIGHT in pixels");
  const std::string seconds = instant.str(1);
  const std::string out =
      arguments.out.empty() ? fmt::format("{}-{}s.png", show.name, seconds) : arguments.out;
  const fs::path whole = fs::absolute(out);
  if (is_there(whole))
    return fail(ErrorCode::Conflict, out, "is there already: name another file with --out");
  const char* named = std::getenv("CHROMIUM");
  const auto asked = ask_program(
      {named != nullptr ? named : "chromium", "--headless", "--no-sandbox", "--hide-scrollbars",
       "--disable-background-networking", "--use-gl=angle", "--use-angle=swiftshader",
       "--enable-unsafe-swiftshader", "--virtual-time-budget=4000",
       fmt::format("--window-size={},{}", size.str(1), size.str(2)),
       "--screenshot=" + whole.string(), show.url("&still&at=" + seconds)},
      {.patience = std::chrono::minutes(2)});
  if (!asked) return pass(asked);
  constexpr int kNotInstalled = 127;
  if (asked->code == kNotInstalled)
    return fail(ErrorCode::Unsupported, "chromium",
                "takes the picture, and is not installed: apt install chromium");
  if (!is_there(whole))
    return fail(ErrorCode::Io, out, "chromium made no picture; it said: " + asked->said);
  std::cout << out << '\n';
  return kExitOk;
}

Result<int> run_view(const ViewArguments& arguments) {
  const auto files = record::find_recordings({arguments.inputs.begin(), arguments.inputs.end()});
  if (!files) return pass(files);
  if (auto readable = record::RecordingView::open(*files); !readable) return pass(readable);
  const bool picture = !arguments.png.empty();
  sigset_t signals{};
  if (!picture)
    signals = service::block_signals({SIGTERM, SIGINT});  // Before the server's threads start.
  const auto show = show_of(arguments, *files);
  if (!show) return pass(show);
  if (picture) return take_picture(*show, arguments);
  std::cout << show->url() << "\nopen this address in a browser; Ctrl-C ends it\n" << std::flush;
  int signal = 0;
  sigwait(&signals, &signal);
  show->server->stop();
  return kExitOk;
}

}  // namespace

Run add_view(CLI::App& options) {
  const auto arguments = std::make_shared<ViewArguments>();
  options.add_option("recording", arguments->inputs, "A folder, or .mcap files of one recording")
      ->required();
  constexpr int kLastPort = 65535;
  options.add_option("--port", arguments->port, "Port of the page; 0: any")
      ->check(CLI::Range(0, kLastPort))
      ->capture_default_str();
  options.add_option("--png", arguments->png, "Instead: a picture of this instant, t=SECONDS");
  options.add_option("--out", arguments->out, "The picture's file; default: NAME-SECONDSs.png");
  options.add_option("--size", arguments->size, "The picture's size")->capture_default_str();
  return [arguments] { return sniffed(run_view(*arguments), arguments->inputs); };
}

}  // namespace chorus::ctl
