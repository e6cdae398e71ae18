#include "fusion-server/server/site_settings.h"

#include <algorithm>
#include <utility>

#include "common/base/file.h"

namespace chorus::server {
namespace {

constexpr std::size_t kMostPlaces = 1 << 20;

void read_name(ConfigReader& reader, const char* key, std::string& out) {
  reader.read(key, out);
  if (out.empty() || site::CellId::parse(out)) return;
  reader.complain(key, "must be 1 to 64 letters, digits, _ or -");
}

void read_servers(ConfigReader& reader, nats::BrokerConfig& out) {
  reader.read("servers", out.servers);
  for (const std::string& server : out.servers) {
    if (server.starts_with("nats://") || server.starts_with("tls://")) continue;
    reader.complain("servers", "must be like nats://10.0.0.5:4222");
  }
  reader.read("user", out.user);
  reader.read("password", out.password);
  reader.read("ca", out.ca_file);
  if (out.user.empty() && !out.password.empty())
    reader.complain("password", "comes without a user");
}

void read_places_file(ConfigReader& reader, std::string& out) {
  std::string file;
  reader.read("places", file);
  if (file.empty()) return;
  auto text = read_file(file, kMostPlaces);
  if (!text) return reader.complain("places", to_string(text.error()));
  if (const auto places = nats::read_places(*text); !places)
    return reader.complain("places", to_string(places.error()));
  out = std::move(*text);
}

}  // namespace

void read_site(ConfigReader reader, SiteSettings& out, std::string& places) {
  nats::LinkConfig& link = out.link;
  read_name(reader, "name", link.site);
  std::string cell;
  read_name(reader, "cell", cell);
  if (auto id = site::CellId::parse(cell)) link.cell = std::move(*id);
  read_servers(reader, link.broker);
  reader.read("url", link.url);
  read_places_file(reader, places);
  reader.read("outputs", out.outputs_show);
  reader.read_s("remember_s", link.decisions.remember, std::chrono::seconds(0),
                std::chrono::seconds(3600));
  if (link.site.empty()) return;
  if (cell.empty()) reader.complain("cell", "is missing: this cell's name in the site");
  link.broker.name = link.site + "." + cell;
}

std::optional<site::CellPlace> place_in_file(const SiteSettings& settings,
                                             const std::string& places) {
  const auto all = nats::read_places(places);
  if (!all) return std::nullopt;
  const auto own = std::ranges::find(*all, settings.link.cell, &site::CellPlace::cell);
  return own == all->end() ? std::nullopt : std::optional(*own);
}

std::vector<OutputStatus> with_site(std::vector<OutputStatus> all, const nats::CellLink* link) {
  if (link == nullptr) return all;
  const SinkCounters counters = link->counters();
  all.push_back(
      {std::string(link->name()), counters.clients == 0 ? counters.last_failure : "", counters});
  return all;
}

}  // namespace chorus::server
