#include "tests/bench/live/nginx_proxy.h"

#include <fstream>
#include <string>

#include <fmt/format.h>

namespace chorus::bench {

Result<ChildProcess> start_proxy(const ProxyPlan& plan) {
  const std::string folder = plan.folder.string();
  std::ofstream config(plan.folder / "nginx.conf");
  config << "daemon off; master_process off; pid " << folder << "/pid; error_log " << folder
         << "/error.log crit;\n"
         << fmt::format("worker_rlimit_nofile {};\n", plan.connections + 64)
         << fmt::format("events {{ worker_connections {}; }}\n", plan.connections)
         << "http { access_log off;\n";
  for (const auto* kind : {"client_body", "proxy", "fastcgi", "uwsgi", "scgi"})
    config << kind << "_temp_path " << folder << "/" << kind << ";\n";
  config << fmt::format(
      "server {{ listen 127.0.0.1:{} backlog=4096; location / {{ proxy_pass http://127.0.0.1:{}; "
      "{} "
      "}} }} }}\n",
      plan.port, plan.upstream, plan.lines);
  config.close();
  return ChildProcess::start(
      kNginx, {"-e", folder + "/error.log", "-p", folder, "-c", folder + "/nginx.conf"});
}

}  // namespace chorus::bench
