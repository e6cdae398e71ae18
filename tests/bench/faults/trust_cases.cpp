// Certificates that expire and are renewed, a token that is wrong, a second tracker that reads the
// same sensors, and a sensor of another version.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>

#include <fmt/format.h>

#include "common/tls/authority.h"
#include "tests/bench/faults/guest.h"
#include "tests/bench/faults/trial.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

constexpr int kTrusting = 3;
constexpr double kTrustedAgain = 1.5;  // until a repaired sensor contributes again, at most [s]
constexpr double kTrustPatience = 8.0;

/// A certificate authority that issues certificates for sensors, as files.
class Authority {
 public:
  Authority() { write("ca.crt", authority_.certificate); }

  void certify(int sensor, const tls::Validity& validity = tls::for_days(30)) const {
    const auto issued = tls::new_certificate(authority_, {"127.0.0.1"}, validity).value();
    write(fmt::format("{}.crt", sensor), issued.certificate);
    write(fmt::format("{}.key", sensor), issued.key);
  }
  [[nodiscard]] static tls::Validity past() {
    tls::Validity validity = tls::for_days(1);
    validity.from -= std::chrono::hours(72);
    validity.until -= std::chrono::hours(48);
    return validity;
  }
  [[nodiscard]] Settings of_sensor(int sensor) const {
    return {"http.tls.certificate=" + path(fmt::format("{}.crt", sensor)),
            "http.tls.key=" + path(fmt::format("{}.key", sensor))};
  }
  [[nodiscard]] CellPlan plan() const {
    CellPlan plan;
    plan.sensors = kTrusting;
    plan.secure = true;
    plan.fusion = {"poll.ca=" + path("ca.crt")};
    for (int i = 0; i < kTrusting; ++i) {
      certify(i);
      plan.of_sensor[i] = of_sensor(i);
    }
    return plan;
  }

 private:
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
  }

  ScratchFolder folder_ = ScratchFolder::make().value();
  tls::Issued authority_ = tls::new_authority("faults", tls::for_days(30)).value();
};

/// Waits until the last error that the server reports of the sensor contains `text`; false if it
/// does not within kTrustPatience.
bool says(const Cell& cell, const std::string& sensor, const std::string& text) {
  return wait_until(kTrustPatience, [&] {
    return cell.told_of(sensor).value("lastError", "").find(text) != std::string::npos;
  });
}

void check_return(Trial& trial, const Watch& watch, const Cell& cell, Timestamp since) {
  (void)wait_until(kTrustPatience,
                   [&] { return std::isfinite(recovery(watch.seen(), since, cell.placed())); });
  trial.check_recovery(recovery(watch.seen(), since, cell.placed()), kTrustedAgain);
}

Result<void> certificate_expired(Trial& trial) {
  const Authority authority;
  auto cell = Cell::start(authority.plan());
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  cell->sensor(1).kill();
  authority.certify(1, Authority::past());
  if (auto started = cell->start_sensor(1); !started) return started;
  trial.check(says(*cell, "s2", "has expired"), "/sensors/s2 says that it has expired");
  wait_for(2.0);
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), {"s1", "s3"});
  authority.certify(1);
  const Timestamp renewed = now();
  cell->sensor(1).send(SIGHUP);
  check_return(trial, watch, *cell, renewed);
  return {};
}

/// All sensors get new certificates while they run, and every connection that is open must go on.
Result<void> certificates_renewed(Trial& trial) {
  const Authority authority;
  auto cell = Cell::start(authority.plan());
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  for (int i = 0; i < kTrusting; ++i) {
    authority.certify(i);
    cell->sensor(i).send(SIGHUP);
  }
  wait_for(4.0);
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), cell->placed());
  return {};
}

Result<void> wrong_token(Trial& trial) {
  auto cell = Cell::start({.sensors = kTrusting});
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  cell->sensor(1).kill();
  cell->change_sensor(1, {R"(http.tokens=[{"token":"abcdefabcdef","role":"read"}])"});
  if (auto started = cell->start_sensor(1); !started) return started;
  trial.check(says(*cell, "s2", "token"), "/sensors/s2 says that a token is missing");
  wait_for(2.0);
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), {"s1", "s3"});
  cell->sensor(1).kill();
  cell->change_sensor(1, {});
  if (auto started = cell->start_sensor(1); !started) return started;
  check_return(trial, watch, *cell, now());
  return {};
}

Result<void> two_servers(Trial& trial) {
  auto cell = Cell::start({.sensors = kTrusting});
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  const std::uint16_t port = testing::free_port();
  const std::string places = (cell->folder() / "state" / "registration.json").string();
  const auto second = ChildProcess::start(
      "chorus-fusion",
      {"--config", "deploy/config/fusion.json", "--set", fmt::format("http.port={}", port), "--set",
       "sensors=" + cell->polled(), "--set", "viewer_dir=", "--set", "state_dir=", "--set",
       "registration.file=" + places});
  if (!second) return pass(second);
  if (!wait_until(kTrustPatience, [&] { return ask_port(port, {"GET", "/healthz"}).status != 0; }))
    return fail(ErrorCode::Timeout, "the second chorus-fusion", "it does not answer");
  const Watch other(port);
  wait_for(2.0);
  const Timestamp both = now();
  wait_for(4.0);
  const Account account = account_of(other.seen(), both, now());
  trial.check(account.lost == 0, fmt::format("the second server loses {} instants", account.lost));
  for (const std::string& name : cell->placed()) {
    trial.check(account.share_of(name) >= 95.0,
                fmt::format("{} is in {:.0f} % of its frames", name, account.share_of(name)));
  }
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), cell->placed());
  return {};
}

/// A sensor of another version beside ours: it has none of the resources that came later (/clock,
/// /floor), and says more than we know.
Result<void> other_version(Trial& trial) {
  const auto place = place_of(kTrusting, kTrusting + 1);
  Guest guest("other", [place](Timestamp when) {
    auto said = honest(place, when);
    said.behind = "<urn:later:1> <urn:later:mood> \"calm\" ; a <urn:later:Thing> .\n";
    return said;
  });
  auto cell =
      Cell::start({.sensors = kTrusting, .neighbours = {{"other", guest.port(), kTrusting}}});
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  wait_for(4.0);
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), cell->placed());
  return {};
}

}  // namespace

FaultCases trust_cases() {
  return {
      {"certificate-expired", "one of three comes back with a certificate of last week",
       certificate_expired},
      {"certificates-renewed", "all three get new certificates while they run",
       certificates_renewed},
      {"wrong-token", "one of three comes back and wants a token that the server has not",
       wrong_token},
      {"two-servers", "a second server reads the same sensors", two_servers},
      {"other-version", "a fourth sensor of another version says less and more than ours",
       other_version},
  };
}

}  // namespace chorus::bench
