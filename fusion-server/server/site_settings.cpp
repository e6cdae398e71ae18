#include "fusion-server/server/site_settings.h"

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

void read_places_file(ConfigReader& reader, SiteSettings& out) {
  reader.read("places", out.places_file);
  if (out.places_file.empty()) return;
  const auto text = read_file(out.places_file, kMostPlaces);
  if (!text) return reader.complain("places", to_string(text.error()));
  auto places = nats::read_places(*text);
  if (!places) return reader.complain("places", to_string(places.error()));
  out.link.places = std::move(*places);
}

}  // namespace

void read_site(ConfigReader reader, SiteSettings& out) {
  nats::LinkConfig& link = out.link;
  read_name(reader, "name", link.site);
  std::string cell;
  read_name(reader, "cell", cell);
  if (auto id = site::CellId::parse(cell)) link.cell = std::move(*id);
  read_servers(reader, link.broker);
  reader.read("url", link.url);
  read_places_file(reader, out);
  reader.read("outputs", out.outputs_show);
  reader.read_s("remember_s", link.decisions.remember, std::chrono::seconds(0),
                std::chrono::seconds(3600));
  if (link.site.empty()) return;
  if (cell.empty()) reader.complain("cell", "is missing: this cell's name in the site");
  link.broker.name = link.site + "." + cell;
}

}  // namespace chorus::server
