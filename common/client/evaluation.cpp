#include "common/client/evaluation.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/parse.h"
#include "common/client/service_client.h"

namespace chorus::client {
namespace {

Result<Document> read_evaluation(std::string_view text, resource::Format /*json*/,
                                 const SensorId& /*expected*/) {
  const auto told = parse_json(text);
  if (!told) return pass(told);
  const double sequence = number_at(*told, "sequence");
  const auto captured = parse_number<std::int64_t>(text_at(*told, "capturedNanoseconds", ""));
  if (text_at(*told, "@type", "") != "Evaluation" || !(sequence >= 0.0) || !captured)
    return fail(ErrorCode::Malformed, "evaluation", "is no document of a chorus-evaluation");
  return resource::document_of_value(std::make_shared<const EvaluationText>(EvaluationText{
      static_cast<std::uint64_t>(sequence), from_unix_ns(*captured), std::string(text)}));
}

}  // namespace

const KindOf<EvaluationText> kEvaluations{
    {"evaluation", "evaluations/", false, resource::Format::Json, read_evaluation}};

}  // namespace chorus::client
