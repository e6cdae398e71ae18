#include "common/service/live_documents.h"

namespace chorus::service {

using http::DocumentOptions;
using http::PathParams;
using http::Request;

tl::unexpected<Error> not_yet(std::string where, std::string_view what) {
  return fail(ErrorCode::Unavailable, std::move(where),
              "there has been no " + std::string(what) + " yet; ask again in a second");
}

LiveDocuments::LiveDocuments(Serving serving, const DocumentHistory& history,
                             const ServedKind& kind)
    : serving_(std::move(serving)),
      kind_(kind),
      ring_(history, kind),
      live_(std::make_shared<http::LiveDocument>()) {}

void LiveDocuments::publish(const Document& document) {
  ring_.push(document);
  live_->publish(kind_.document(document.value, serving_.place(std::string(kind_.path)),
                                resource::latest_options(document, kind_.kept, serving_.run)));
}

Result<Document> LiveDocuments::of_time(const std::string& time) const {
  if (time != "now" || !now_) return ring_.at(time);
  if (auto document = now_(); document.value) return document;
  return not_yet("/" + std::string(kind_.path) + "?at=now", kind_.what);
}

Result<http::DocumentPtr> LiveDocuments::at(const Request& request) const {
  const std::string amendments = std::to_string(ring_.amendments());
  const auto asked = request.query.find("at");
  auto document = of_time(asked == request.query.end() ? std::string() : asked->second);
  if (!document) return pass(document);
  DocumentOptions options;
  options.version =
      std::to_string(to_unix_ns(document->captured)) + "-" + amendments + "." + serving_.run;
  return kind_.document(std::move(document->value), serving_.place(std::string(kind_.path)),
                        std::move(options));
}

Result<http::DocumentPtr> LiveDocuments::kept(const std::string& sequence) const {
  auto document = ring_.find(sequence);
  if (!document) return pass(document);
  auto options = resource::kept_options(*document, serving_.run);
  return kind_.document(std::move(document->value),
                        serving_.place(std::string(kind_.kept) + sequence), std::move(options));
}

void LiveDocuments::add_routes(http::Router& router) {
  const std::string latest = "/" + std::string(kind_.path);
  router.live(latest, live_);
  router.by_query(latest, "at",
                  [this](const Request& request, const PathParams&) { return at(request); });
  router.get("/" + std::string(kind_.kept) + "{seq}",
             [this](const Request&, const PathParams& path) { return kept(path.at("seq")); });
}

}  // namespace chorus::service
