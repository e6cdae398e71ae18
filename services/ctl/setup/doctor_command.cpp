// chorus doctor: checks whether this host is ready for its services, and says what to do if it is
// not.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/version.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/server_option.h"
#include "services/ctl/operate/running_findings.h"
#include "services/ctl/setup/findings.h"
#include "services/ctl/setup/site_findings.h"

namespace chorus::ctl {
namespace {

struct DoctorArguments {
  std::string folder = "/etc/chorus";
  bool json = false;
};

void append(Findings& all, Findings more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

void examine(const std::string& kind, const std::string& file, Findings& all) {
  const auto service = examined_service(kind, file);
  if (!service) {
    all.push_back({false, file, to_string(service.error()),
                   "read it as root (sudo chorus doctor), or mend what the error names"});
    return;
  }
  append(all, check_findings(*service));
  all.push_back(health_finding(*service));
  append(all, configuration_findings(*service));
  all.push_back(token_finding(*service));
  append(all, certificate_findings(*service));
  append(all, disk_findings(*service));
  append(all, sensor_findings(*service));
  append(all, followed_findings(*service));
  append(all, site_findings(*service));
}

Findings examine_all(const std::string& folder) {
  Findings all{clock_finding(read_ntp_status())};
  bool any = false;
  for (const std::string kind : {"sensor", "fusion"}) {
    const std::string file = folder + "/" + kind + ".json";
    std::error_code hidden;
    if (!std::filesystem::exists(file, hidden) && !hidden) continue;
    examine(kind, file, all);
    any = true;
  }
  if (!any) {
    all.push_back({false, "configuration", "there is none in " + folder,
                   "chorus init sensor or chorus init fusion writes one"});
  }
  return all;
}

void print(const Findings& all) {
  for (const Finding& finding : all) {
    std::cout << fmt::format("{:5}  {}: {}\n", finding.good ? "ok" : "WRONG",
                             printable(finding.subject), printable(finding.words));
    if (!finding.good) std::cout << "       -> " << printable(finding.advice) << "\n";
  }
}

nlohmann::json json_of(const Findings& all) {
  nlohmann::json list = nlohmann::json::array();
  for (const Finding& f : all)
    list.push_back(
        {{"good", f.good}, {"subject", f.subject}, {"words", f.words}, {"advice", f.advice}});
  return {{"version", std::string(version())}, {"findings", list}};
}

Result<int> run_doctor(const DoctorArguments& arguments) {
  const Findings all = examine_all(arguments.folder);
  if (arguments.json) {
    std::cout << json_text(json_of(all));
  } else {
    print(all);
  }
  const auto is_good = [](const Finding& finding) { return finding.good; };
  return std::all_of(all.begin(), all.end(), is_good) ? kExitOk : kExitFailed;
}

}  // namespace

Run add_doctor(CLI::App& options) {
  const auto arguments = std::make_shared<DoctorArguments>();
  options.add_option("--folder", arguments->folder, "Where the configurations are")
      ->capture_default_str();
  add_authority_option(options);
  options.add_flag("--json", arguments->json, "Report as JSON");
  return [arguments] { return run_doctor(*arguments); };
}

}  // namespace chorus::ctl
