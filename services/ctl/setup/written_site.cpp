#include "services/ctl/setup/written_site.h"

#include <crypt.h>

#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/config_reader.h"
#include "common/base/file.h"
#include "common/base/strong_id.h"
#include "common/client/service_client.h"
#include "services/ctl/line/new_file.h"
#include "services/ctl/setup/written_config.h"

namespace chorus::ctl {
namespace {

/// nats-server's own default; a connection costs a twentieth of a second of it.
constexpr unsigned long kBcryptCost = 10;
constexpr const char* kReader = "reader";

std::string as_json(const std::string& text) { return nlohmann::json(text).dump(); }

std::string bcrypt_of(const std::string& password) {
  char* salt = crypt_gensalt_ra("$2b$", kBcryptCost, nullptr, 0);
  if (salt == nullptr) throw std::runtime_error("bcrypt is missing in this system's libcrypt");
  crypt_data work{};
  const char* hash = crypt_r(password.c_str(), salt, &work);
  std::free(salt);  // NOLINT: allocated by crypt_gensalt_ra
  if (hash == nullptr || *hash == '*') throw std::runtime_error("the password cannot be hashed");
  return hash;
}

std::string server_url(const SiteWishes& wishes) {
  const bool six = wishes.address.find(':') != std::string::npos;
  return fmt::format("{}://{}{}{}:{}", wishes.tls.empty() ? "nats" : "tls", six ? "[" : "",
                     wishes.address, six ? "]" : "", wishes.port);
}

std::string cell_user(const SiteWishes& wishes, const std::string& cell,
                      const std::string& password) {
  return fmt::format(
      "      {{ user: {0}, password: {1}\n"
      "        permissions: {{\n"
      "          publish: {{\n"
      "            allow: [\"chorus.{2}.{3}.>\", \"chorus.{2}.*.ask.>\", \"$KV.chorus_cells.{3}\", "
      "\"$KV.chorus_people.>\", \"$JS.API.>\", \"$JS.ACK.>\", \"$JS.FC.>\"]\n"
      "            deny: [\"$JS.API.STREAM.DELETE.>\", \"$JS.API.STREAM.PURGE.>\", "
      "\"$JS.API.STREAM.UPDATE.>\", \"$JS.API.STREAM.MSG.DELETE.>\", "
      "\"$JS.API.CONSUMER.DELETE.>\"]\n"
      "          }}\n"
      "          subscribe: [\"chorus.{2}.>\", \"_INBOX.{3}.>\"]\n"
      "          allow_responses: true\n"
      "        }} }}\n",
      as_json(cell), as_json(bcrypt_of(password)), wishes.name, cell);
}

std::string tls_section(const std::string& folder) {
  if (folder.empty()) return {};
  return fmt::format("tls {{ cert_file: {}, key_file: {}, timeout: 5 }}\n",
                     as_json(folder + "/host.crt"), as_json(folder + "/host.key"));
}

}  // namespace

Result<void> check_site(const SiteWishes& wishes) {
  if (!SensorId::parse(wishes.name))
    return fail(ErrorCode::InvalidArgument, "--name",
                "must name the hall: 1 to 64 letters, digits, _ or -");
  if (wishes.cells.empty())
    return fail(ErrorCode::InvalidArgument, "--cell", "must name each cell: --cell a --cell b");
  std::set<std::string> names{kReader};
  for (const std::string& cell : wishes.cells) {
    if (!SensorId::parse(cell))
      return fail(ErrorCode::InvalidArgument, cell,
                  "is no name of a cell: 1 to 64 letters, digits, _ or -");
    if (!names.insert(cell).second)
      return fail(ErrorCode::InvalidArgument, cell,
                  cell == kReader ? "is the user who only reads" : "is the name of two cells");
  }
  return {};
}

std::string server_config(const SiteWishes& wishes, const std::vector<std::string>& passwords) {
  std::string users;
  for (std::size_t i = 0; i < wishes.cells.size(); ++i)
    users += cell_user(wishes, wishes.cells[i], passwords[i]);
  users += fmt::format(
      "      {{ user: {}, password: {}\n"
      "        permissions: {{ publish: [\"chorus.{}.*.ask.>\"], subscribe: [\"chorus.{}.>\", "
      "\"_INBOX.{}.>\"] }} }}\n",
      as_json(kReader), as_json(bcrypt_of(passwords.back())), wishes.name, wishes.name, kReader);
  return fmt::format(
      "# The server by which the cells of \"{0}\" meet, written by chorus init site.  A new cell: "
      "chorus init site\n"
      "# again into an empty folder.  Nobody comes in without a password; each cell publishes "
      "under its own name only,\n# but may write the record of any person.\n"
      "listen: {1}\n"
      "server_name: {2}\n"
      "max_payload: 1MB\n"
      "max_connections: 256\n"
      "write_deadline: \"2s\"\n"
      "{3}"
      "jetstream {{ store_dir: {4}, max_memory_store: 16MB, max_file_store: 256MB }}\n"
      "accounts {{\n"
      "  CHORUS {{\n"
      "    jetstream: enabled\n"
      "    users: [\n"
      "{5}"
      "    ]\n"
      "  }}\n"
      "}}\n",
      wishes.name, as_json(fmt::format("{}:{}", wishes.listen, wishes.port)), as_json(wishes.name),
      tls_section(wishes.tls), as_json(wishes.store), users);
}

std::string cell_config(const SiteWishes& wishes, const std::string& cell,
                        const std::string& password) {
  nlohmann::ordered_json section{{"name", wishes.name},
                                 {"cell", cell},
                                 {"servers", {server_url(wishes)}},
                                 {"user", cell},
                                 {"password", password}};
  if (!wishes.tls.empty()) section["ca"] = wishes.tls + "/ca.crt";
  return nlohmann::ordered_json{{"site", section}}.dump(2) + "\n";
}

Result<void> write_site(const SiteWishes& wishes) {
  if (auto ok = check_site(wishes); !ok) return ok;
  std::vector<std::string> passwords;
  for (std::size_t i = 0; i <= wishes.cells.size(); ++i) passwords.push_back(new_token());
  if (auto ok = make_folder(wishes.folder, Readers::Services); !ok) return ok;
  const auto write = [&wishes](const std::string& name, const std::string& text) {
    return write_file(wishes.folder + "/" + name, text, Readers::Services);
  };
  if (auto ok = write("nats-server.conf", server_config(wishes, passwords)); !ok) return ok;
  for (std::size_t i = 0; i < wishes.cells.size(); ++i) {
    const std::string& cell = wishes.cells[i];
    if (auto ok = write(cell + ".json", cell_config(wishes, cell, passwords[i])); !ok) return ok;
  }
  const nlohmann::ordered_json reader{{"servers", {server_url(wishes)}},
                                      {"user", kReader},
                                      {"password", passwords.back()},
                                      {"inboxPrefix", std::string("_INBOX.") + kReader}};
  return write(std::string(kReader) + ".json", reader.dump(2) + "\n");
}

Result<void> check_authority(const std::string& cell) {
  const auto told = nlohmann::json::parse(cell, nullptr, false);
  const std::string file = client::text_at(client::part_at(told, "site"), "ca", "");
  if (file.empty() || is_there(file)) return {};
  return fail(ErrorCode::NotFound, file,
              "is missing, by which this cell knows the site's server: copy ca.crt from the "
              "server's host to there, or change \"ca\" in the file of --join");
}

Result<std::string> joined_config(const std::string& fusion, const std::string& cell) {
  const auto whole = ConfigReader::parse(fusion, "the configuration");
  if (!whole) return pass(whole);
  if (whole->has("site"))
    return fail(ErrorCode::Conflict, "site",
                "is a section of the configuration already: take it out first");
  const auto joined = ConfigReader::parse(cell, "--join");
  if (!joined) return pass(joined);
  if (!joined->has("site"))
    return fail(ErrorCode::InvalidArgument, "--join",
                "has no section \"site\": name a CELL.json that chorus init site wrote");
  const std::string section = nlohmann::ordered_json::parse(joined->text("site")).dump(2);
  // The last brace that is not in a comment; whether a comma is wanted depends on what is before.
  for (std::size_t at = fusion.rfind('}'); at != std::string::npos && at > 0;
       at = fusion.rfind('}', at - 1)) {
    for (const char* comma : {",\n", "\n"}) {
      const std::string text =
          fusion.substr(0, at) + comma +
          "// The hall that this cell is part of (docs/guide/hall.md).\n\"site\": " + section +
          "\n" + fusion.substr(at);
      const auto tried = ConfigReader::parse(text, "joined");
      if (tried && tried->has("site")) return text;
    }
  }
  return fail(ErrorCode::Malformed, "the configuration", "has no end where a section could go");
}

}  // namespace chorus::ctl
