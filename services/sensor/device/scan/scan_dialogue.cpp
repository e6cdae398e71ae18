#include "services/sensor/device/scan/scan_dialogue.h"

#include <openssl/evp.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace chorus::scan {
namespace {

using Json = nlohmann::json;

std::string base64_of(std::string_view bytes) {
  std::vector<unsigned char> out(4 * ((bytes.size() + 2) / 3) + 1);
  const int size = EVP_EncodeBlock(out.data(), reinterpret_cast<const unsigned char*>(bytes.data()),
                                   static_cast<int>(bytes.size()));
  return {reinterpret_cast<const char*>(out.data()), static_cast<std::size_t>(std::max(0, size))};
}

Result<std::string> bytes_of(const std::string& base64) {
  std::string out(base64.size() / 4 * 3 + 3, '\0');
  const int size = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                                   reinterpret_cast<const unsigned char*>(base64.data()),
                                   static_cast<int>(base64.size()));
  if (size <= 0) return fail(ErrorCode::Malformed, "photo", "must be a picture in base64");
  // The decoder counts what was only padding.
  const auto padding = static_cast<std::size_t>(base64.ends_with("==") ? 2 : base64.ends_with('='));
  out.resize(static_cast<std::size_t>(size) - padding);
  return out;
}

Result<Photo> photo_in(std::string_view text) {
  const Json message = Json::parse(text, nullptr, false);
  const auto word = [&](const char* key, const char* otherwise) {
    const auto found = message.find(key);
    return found != message.end() && found->is_string() ? found->get<std::string>()
                                                        : std::string(otherwise);
  };
  if (!message.is_object() || word("type", "") != "scan")
    return fail(ErrorCode::Malformed, "type", "must be \"scan\"");
  const std::string scale = word("scale", "none");
  if (scale != "a4" && scale != "card" && scale != "none")
    return fail(ErrorCode::Malformed, "scale", "must be \"a4\", \"card\" or \"none\"");
  const std::string view = word("view", "palm");
  if (view != "palm" && view != "back")
    return fail(ErrorCode::Malformed, "view", "must be \"palm\" or \"back\"");
  auto bytes = bytes_of(word("photo", ""));
  if (!bytes) return pass(bytes);
  return Photo{std::move(*bytes), scale == "none" ? "" : scale, view == "back"};
}

http::Reply refused(const Error& error) {
  return {{Json{{"type", "refused"},
                {"code", name_of(error.code)},
                {"context", error.context},
                {"detail", error.message}}
               .dump(-1, ' ', false, Json::error_handler_t::replace)}};
}

class ScanDialogue final : public http::Dialogue {
 public:
  explicit ScanDialogue(std::shared_ptr<ScanDesk> desk) : desk_(std::move(desk)) {}

  [[nodiscard]] http::Reply hear(std::string_view message) override {
    if (ticket_)
      return refused({ErrorCode::Conflict, "scan", "the photo before this one is not done yet"});
    auto photo = photo_in(message);
    if (!photo) return refused(photo.error());
    auto ticket = desk_->take(std::move(*photo));
    if (!ticket) return refused(ticket.error());
    ticket_ = std::move(*ticket);
    return {};
  }

  [[nodiscard]] http::Reply look() override {
    if (!ticket_) return {};
    const auto answer = ticket_->answer();
    if (!answer) return {};
    ticket_.reset();
    if (!*answer) return refused(answer->error());
    const PhotoAnswer& hand = **answer;
    return {{Json{{"type", "hand"},
                  {"bvh", hand.bvh},
                  {"htr", hand.htr},
                  {"picture", base64_of(hand.jpeg)},
                  {"report", Json::parse(hand.report, nullptr, false)}}
                 .dump(-1, ' ', false, Json::error_handler_t::replace)}};
  }

  [[nodiscard]] http::Reply end(const Error& why) override {
    http::Reply out = refused(why);
    out.over = true;
    return out;
  }

 private:
  std::shared_ptr<ScanDesk> desk_;
  std::shared_ptr<Ticket> ticket_;
};

}  // namespace

std::unique_ptr<http::Dialogue> scan_dialogue(std::shared_ptr<ScanDesk> desk) {
  return std::make_unique<ScanDialogue>(std::move(desk));
}

http::DialogueRoute scan_route(std::shared_ptr<ScanDesk> desk) {
  const auto open = [desk = std::move(desk)](const std::string&) {
    return Result<std::unique_ptr<http::Dialogue>>(scan_dialogue(desk));
  };
  return {open, "chorus.scan", kMaxScanMessage, kMaxScanMessage};
}

}  // namespace chorus::scan
