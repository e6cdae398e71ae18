// A fusion server in this process whose answers a test writes down.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/http/server.h"
#include "tests/support/matchers.h"

namespace chorus::ctl {

class ScriptedServer {
 public:
  using Texts = std::map<std::string, std::vector<std::string>>;

  /// `texts` maps each path to its answers, one per request; the last one serves all later
  /// requests.  While a path's list is empty, it is not available yet (503).  `refusal`: the error
  /// that POST /registration is answered with.
  explicit ScriptedServer(Texts texts, std::optional<Error> refusal = std::nullopt)
      : texts_(std::move(texts)), refusal_(std::move(refusal)) {
    auto router = std::make_shared<http::Router>();
    for (const auto& [path, ignored] : texts_) {
      const std::string key = path;
      router->get(path, [this, key](const http::Request&, const http::PathParams&) {
        return document(key);
      });
    }
    router->action(http::Method::Post, "/registration",
                   [this](const http::Request& request, const http::PathParams&) {
                     return started(std::string(request.body));
                   });
    for (const std::string what : {"undo", "accept", "decline"}) {
      const std::string path = "/registration/" + what;
      router->action(http::Method::Post, path, [this, path](const auto&, const auto&) {
        note("POST " + path);
        const auto now = document("/registration");
        if (!now) return Result<http::ActionResult>(tl::unexpected(now.error()));
        return Result<http::ActionResult>(http::ActionResult{200, *now, {}});
      });
    }
    router->action(http::Method::Post, "/registration/origin",
                   [this](const http::Request& request, const http::PathParams&) {
                     note("POST /registration/origin " + std::string(request.body));
                     const auto now = document("/registration");
                     if (!now) return Result<http::ActionResult>(tl::unexpected(now.error()));
                     return Result<http::ActionResult>(http::ActionResult{200, *now, {}});
                   });
    for (const char* path : {"/registration", "/sessions/7"})
      router->action(http::Method::Delete, path, [this, path](const auto&, const auto&) {
        note("DELETE " + std::string(path));
        return Result<http::ActionResult>(http::ActionResult{204});
      });
    server_ = std::make_unique<http::Server>(http::ServerConfig{}, router);
    EXPECT_THAT(server_->start(), chorus::testing::IsOk());
  }

  [[nodiscard]] std::string url() const {
    return "http://127.0.0.1:" + std::to_string(server_->port()) + "/";
  }
  [[nodiscard]] std::uint64_t connections() const { return server_->counters().connections_total; }
  /// Requests that wrote: "POST {...}", "DELETE /registration".
  [[nodiscard]] std::vector<std::string> written() const {
    const std::scoped_lock lock(mutex_);
    return written_;
  }
  void say(const std::string& path, const std::string& text) {
    const std::scoped_lock lock(mutex_);
    texts_[path] = {text};
  }

 private:
  Result<http::DocumentPtr> document(const std::string& path) {
    const std::scoped_lock lock(mutex_);
    auto& left = texts_.at(path);
    if (left.empty()) return fail(ErrorCode::Unavailable, path, "nothing yet");
    const std::string text = left.front();
    if (left.size() > 1) left.erase(left.begin());
    return http::make_document("application/json", text,
                               {std::to_string(std::hash<std::string>{}(text))});
  }
  Result<http::ActionResult> started(const std::string& body) {
    note("POST " + body);
    if (refusal_) return tl::unexpected(*refusal_);
    const auto session = document("/registration");
    if (!session) return pass(session);
    return http::ActionResult{202, *session, "/sessions/7"};
  }
  void note(std::string what) {
    const std::scoped_lock lock(mutex_);
    written_.push_back(std::move(what));
  }

  Texts texts_;
  std::optional<Error> refusal_;
  mutable std::mutex mutex_;
  std::vector<std::string> written_;
  std::unique_ptr<http::Server> server_;
};

}  // namespace chorus::ctl
