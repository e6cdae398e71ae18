// The resources of one kind of live document: the latest (/frame), those kept by number
// (/frames/{seq}) and that of an instant (/frame?at=TIME, /frame?at=now).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "common/http/router.h"
#include "common/service/document_ring.h"
#include "common/service/serving.h"

namespace chorus::service {

struct ServedKind : RingKind {
  /// The document of a value of this kind at its place.
  http::DocumentPtr (*document)(std::shared_ptr<const void> value, const resource::Place& place,
                                http::DocumentOptions options) = nullptr;
};

/// Thread-safe.  Documents are rendered on the server's thread, and only those that clients ask
/// for.
class LiveDocuments {
 public:
  LiveDocuments(Serving serving, const DocumentHistory& history, const ServedKind& kind);

  /// Sequences must increase within one run of the service.
  void publish(const Document& document);
  /// Adds a better document for an instant that has already been published.  Only ?at= shows it.
  void amend(Document document) { ring_.amend(std::move(document)); }
  [[nodiscard]] Document newest() const { return ring_.newest(); }

  /// What ?at=now answers: the document expected at the present moment, without a value before the
  /// first one.  Without it nothing is predicted.  Call it before the first request; `now` must be
  /// thread-safe.
  void predict_with(std::function<Document()> now) { now_ = std::move(now); }

  /// The router keeps using this object, so the object must outlive it.
  void add_routes(http::Router& router);

  [[nodiscard]] const Serving& serving() const { return serving_; }

 private:
  [[nodiscard]] Result<http::DocumentPtr> at(const http::Request& request) const;
  [[nodiscard]] Result<Document> of_time(const std::string& time) const;
  [[nodiscard]] Result<http::DocumentPtr> kept(const std::string& sequence) const;

  Serving serving_;
  ServedKind kind_;
  DocumentRing ring_;
  std::function<Document()> now_;
  std::shared_ptr<http::LiveDocument> live_;
};

/// 503: there is nothing at `where` yet.
[[nodiscard]] tl::unexpected<Error> not_yet(std::string where, std::string_view what);

}  // namespace chorus::service
