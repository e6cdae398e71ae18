#include "common/http/problem.h"

#include <nlohmann/json.hpp>

#include "common/http/status.h"

namespace chorus::http {
namespace {

/// Owns the strings that an Answer points to.
struct Text {
  std::string head;
  std::string body;
};

}  // namespace

Problem problem_of(const Error& error) {
  return {http_status(error.code), name_of(error.code), {}, error.context, error.message};
}

std::string problem_json(const Problem& problem) {
  nlohmann::ordered_json json;
  json["type"] = "about:blank";
  json["title"] = reason_phrase(problem.status);
  json["status"] = problem.status;
  json["detail"] = problem.detail;
  if (!problem.instance.empty()) json["instance"] = problem.instance;
  if (!problem.code.empty()) json["code"] = problem.code;
  if (!problem.context.empty()) json["context"] = problem.context;
  if (!problem.available.empty()) json["available"] = problem.available;
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Answer problem_answer(const Problem& problem, bool head_only) {
  auto text = std::make_shared<Text>();
  text->body = problem_json(problem);
  text->head =
      "Content-Type: application/problem+json\r\nCache-Control: no-store\r\nContent-Length: " +
      std::to_string(text->body.size()) + "\r\n\r\n";
  Answer answer;
  answer.status = problem.status;
  answer.own = text->head;
  if (!head_only) answer.body = text->body;
  if (problem.status == status::kUnavailable) answer.extra = "Retry-After: 1\r\n";
  answer.owner = std::move(text);
  return answer;
}

}  // namespace chorus::http
