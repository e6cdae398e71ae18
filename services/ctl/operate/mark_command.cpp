// chorus mark TEXT: names the present in the recording that a server is making.
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/client/service_client.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/server_option.h"
#include "services/ctl/operate/no_fusion_server.h"

namespace chorus::ctl {
namespace {

using client::part_at;
using client::ServiceClient;
using client::text_at;

struct MarkArguments {
  std::string url = client::default_server();
  std::string text;
};

/// The name of the recording that runs; NotFound tells how to start one.
Result<std::string> running_recording(const ServiceClient& server, const std::string& url) {
  const auto list = server.get("/recordings/?limit=1000");
  if (!list) return tl::unexpected<Error>(no_fusion_server(server, url, list.error()));
  for (const auto& recording : part_at(*list, "recordings")) {
    if (text_at(recording, "state") == "recording") return text_at(recording, "name");
  }
  return fail(ErrorCode::NotFound, url,
              "nothing is being recorded there: start it on the page, or with POST /recordings/");
}

Result<int> run_mark(const MarkArguments& arguments) {
  const auto server = ServiceClient::of(arguments.url);
  if (!server) return pass(server);
  const auto name = running_recording(*server, arguments.url);
  if (!name) return pass(name);
  const auto marks =
      server->post(fmt::format("/recordings/{}/marks", *name), {{"text", arguments.text}});
  if (!marks) return pass(marks);
  std::cout << fmt::format("marked '{}' in {}, which has {} now\n", printable(arguments.text),
                           printable(*name), marks->size());
  return kExitOk;
}

}  // namespace

Run add_mark(CLI::App& options) {
  const auto arguments = std::make_shared<MarkArguments>();
  options.add_option("text", arguments->text, "What happens now, at most 200 bytes")->required();
  add_server_option(options, arguments->url, "The fusion server that records", "url,--url");
  return [arguments] { return run_mark(*arguments); };
}

}  // namespace chorus::ctl
