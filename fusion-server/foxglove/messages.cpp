#include "fusion-server/foxglove/messages.h"

#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/record/frame_schema.h"

namespace chorus::foxglove {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxWishes = 1000;

void put_little_endian(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xFF);
}

std::optional<std::uint32_t> number_at(const Json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object.at(key).is_number_unsigned())
    return std::nullopt;
  const auto value = object.at(key).get<std::uint64_t>();
  return value <= 0xFFFFFFFFU ? std::optional(static_cast<std::uint32_t>(value)) : std::nullopt;
}

tl::unexpected<Error> malformed(std::string what) {
  return fail(ErrorCode::Malformed, std::string(kSubprotocol), std::move(what));
}

Result<std::vector<Wish>> subscriptions_of(const Json& list) {
  std::vector<Wish> wishes;
  for (const Json& one : list) {
    const auto id = number_at(one, "id");
    const auto channel = number_at(one, "channelId");
    if (!id || !channel) return malformed("a subscription has the numbers id and channelId");
    wishes.push_back({*id, *channel, false});
  }
  return wishes;
}

Result<std::vector<Wish>> endings_of(const Json& list) {
  std::vector<Wish> wishes;
  for (const Json& one : list) {
    if (!one.is_number_unsigned() || one.get<std::uint64_t>() > 0xFFFFFFFFU)
      return malformed("subscriptionIds are numbers");
    wishes.push_back({one.get<std::uint32_t>(), 0, true});
  }
  return wishes;
}

}  // namespace

std::string server_info(const std::string& name, const std::string& session) {
  return Json{{"op", "serverInfo"},
              {"name", name},
              {"capabilities", Json::array()},
              {"supportedEncodings", Json::array()},
              {"metadata", Json::object()},
              {"sessionId", session}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string advertise(const std::vector<Channel>& channels) {
  Json all = Json::array();
  for (const Channel& channel : channels) {
    all.push_back({{"id", channel.id},
                   {"topic", channel.topic},
                   {"encoding", "json"},
                   {"schemaName", channel.schema},
                   {"schema", record::schema_text(channel.schema)},
                   {"schemaEncoding", "jsonschema"}});
  }
  return Json{{"op", "advertise"}, {"channels", std::move(all)}}.dump();
}

std::string warning(const std::string& text) {
  constexpr int kWarning = 1;
  return Json{{"op", "status"}, {"level", kWarning}, {"message", text}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

std::string message_bytes(std::uint32_t subscription, const Message& message) {
  constexpr char kMessageData = 1;
  const std::string& text = message.text();
  std::string out(1, kMessageData);
  out.reserve(text.size() + 13);
  put_little_endian(out, subscription, 4);
  put_little_endian(out, static_cast<std::uint64_t>(to_unix_ns(message.at())), 8);
  return out += text;
}

Result<std::vector<Wish>> wishes_of(std::string_view text) {
  constexpr JsonLimits kLimits{64 * 1024, 8};
  const auto json = parse_json(text, kLimits);
  if (!json || !json->is_object() || !json->contains("op") || !json->at("op").is_string())
    return malformed("a message is a JSON object with the text op");
  const auto op = json->at("op").get<std::string>();
  const bool begins = op == "subscribe";
  if (!begins && op != "unsubscribe") return std::vector<Wish>{};
  const char* key = begins ? "subscriptions" : "subscriptionIds";
  if (!json->contains(key) || !json->at(key).is_array() || json->at(key).size() > kMaxWishes)
    return malformed(op + " has the list " + key + ", of at most 1000");
  return begins ? subscriptions_of(json->at(key)) : endings_of(json->at(key));
}

}  // namespace chorus::foxglove
