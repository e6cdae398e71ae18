#include "fusion-server/server/picture_desk.h"

#include <utility>

#include "common/base/log.h"
#include "common/client/service_client.h"
#include "common/http/client.h"
#include "common/http/status.h"
#include "common/resource/link_lines.h"

namespace chorus::server {
namespace {

using std::chrono::steady_clock;

constexpr auto kFresh = std::chrono::milliseconds(400);  ///< Until then the same picture is good.
constexpr auto kKept = std::chrono::seconds(10);         ///< An older picture would mislead.
constexpr http::ClientLimits kPictureLimits{.max_body_bytes = 4u << 20,
                                            .connect_timeout = std::chrono::milliseconds(1000),
                                            .answer_timeout = std::chrono::milliseconds(1500)};

/// The image as the sensor sent it, or why it sends none, in words for the operator.
Result<http::ClientResponse> image_of(const client::FollowedService& service) {
  auto url = http::parse_url(service.url);
  if (!url) return pass(url);
  http::ClientRequest request;
  request.target = url->target + (url->target.ends_with('/') ? "" : "/") + "images/color";
  if (!service.token.empty())
    request.headers.emplace_back("Authorization", "Bearer " + service.token);
  auto answer = http::fetch(*url, request, kPictureLimits, service.trust);
  if (!answer) return pass(answer);
  if (answer->status == http::status::kOk) return answer;
  if (answer->status == http::status::kUnauthorized || answer->status == http::status::kForbidden)
    return fail(
        ErrorCode::Unavailable, "image",
        "the sensor shows pictures only to a token of role \"images\": give the server one");
  return tl::unexpected<Error>(client::refusal_of(*answer, "image"));
}

}  // namespace

void PictureDesk::fetch(const std::string& id, const client::FollowedService& service) {
  auto answer = image_of(service);
  const std::scoped_lock lock(mutex_);
  Picture& picture = pictures_[id];
  picture.asked = false;
  picture.at = steady_clock::now();
  picture.trouble = answer ? "" : answer.error().message;
  picture.document = nullptr;
  if (!answer) return;
  http::DocumentOptions options;
  options.version = run_ + "-" + std::to_string(++version_);
  options.cache_control = "no-store";
  const auto type = answer->headers.find("content-type");
  const bool image = type != answer->headers.end() && type->second.starts_with("image/");
  if (!image) {
    picture.trouble = "the sensor sends no image";
    return;
  }
  picture.document =
      resource::other_document(type->second, std::move(answer->body), std::move(options));
}

Result<http::DocumentPtr> PictureDesk::newest(const std::string& id) {
  const auto service = service_of_(id);
  const std::string where = "sensors/" + id + "/image";
  if (!service) return fail(ErrorCode::NotFound, where, "no sensor of this id is polled");
  const auto now = steady_clock::now();
  const std::scoped_lock lock(mutex_);
  Picture& picture = pictures_[id];
  if (!picture.asked && now - picture.at > kFresh) {
    picture.asked = true;
    worker_.post([this, id, service = *service] { fetch(id, service); });
  }
  if (picture.document && now - picture.at < kKept) return picture.document;
  if (!picture.trouble.empty()) return fail(ErrorCode::NotFound, where, picture.trouble);
  return fail(ErrorCode::Unavailable, where, "the picture is being fetched; ask again in a second");
}

void PictureDesk::add_routes(http::Router& router) {
  router.get("/sensors/{id}/image", [this](const http::Request&, const http::PathParams& params) {
    return newest(params.at("id"));
  });
  router.shows_people("/sensors/{id}/image");
}

}  // namespace chorus::server
