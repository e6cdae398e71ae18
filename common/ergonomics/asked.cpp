#include "common/ergonomics/asked.h"

#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace chorus::ergonomics {
namespace {

using nlohmann::json;

struct Flag {
  std::string_view name;
  std::optional<bool> Asked::*field;
};
constexpr std::array kFlags{Flag{"shock", &Asked::shock},
                            Flag{"wristTwisted", &Asked::wrist_twisted},
                            Flag{"armSupported", &Asked::arm_supported},
                            Flag{"heldOverMinute", &Asked::held_over_minute},
                            Flag{"repeated", &Asked::repeated},
                            Flag{"unstable", &Asked::unstable}};
constexpr std::array<std::pair<std::string_view, Coupling>, 4> kCouplings{
    {{"good", Coupling::Good},
     {"fair", Coupling::Fair},
     {"poor", Coupling::Poor},
     {"unacceptable", Coupling::Unacceptable}}};
constexpr std::array<std::pair<std::string_view, Wrist>, 3> kWrists{
    {{"measured", Wrist::Measured}, {"straight", Wrist::Straight}, {"bent", Wrist::Bent}}};

Error wrong(const std::string& where, std::string_view field, std::string message) {
  return {ErrorCode::InvalidArgument, fmt::format("{}.{}", where, field), std::move(message)};
}

template <class Word, std::size_t N>
Result<std::optional<Word>> word(const json& fields, const char* name,
                                 const std::array<std::pair<std::string_view, Word>, N>& words,
                                 const std::string& where) {
  if (!fields.contains(name)) return std::optional<Word>{};
  const json& value = fields[name];
  std::string known;
  for (const auto& [text, meaning] : words) {
    if (value.is_string() && value.get_ref<const std::string&>() == text) return meaning;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", text);
  }
  return tl::unexpected<Error>(wrong(where, name, "must be one of: " + known));
}

Result<std::optional<double>> load(const json& fields, const std::string& where) {
  if (!fields.contains("loadKg")) return std::optional<double>{};
  const json& value = fields["loadKg"];
  if (!value.is_number() || value.get<double>() < 0)
    return tl::unexpected<Error>(
        wrong(where, "loadKg", "must be a number of kilograms, at least 0"));
  if (value.get<double>() > kMostLoad)
    return tl::unexpected<Error>(
        wrong(where, "loadKg",
              fmt::format("is {:g}; nobody holds that. If it is newtons, divide by 9.81: {:.1f} kg",
                          value.get<double>(), value.get<double>() / 9.81)));
  return std::optional<double>(value.get<double>());
}

}  // namespace

bool is_asked_field(const std::string& name) {
  if (name == "loadKg" || name == "coupling" || name == "wrist") return true;
  for (const Flag& flag : kFlags) {
    if (flag.name == name) return true;
  }
  return false;
}

Result<Asked> read_asked(const json& fields, const std::string& where) {
  Asked asked;
  const auto kilograms = load(fields, where);
  if (!kilograms) return pass(kilograms);
  asked.load_kg = *kilograms;
  const auto coupling = word(fields, "coupling", kCouplings, where);
  if (!coupling) return pass(coupling);
  asked.coupling = *coupling;
  const auto wrist = word(fields, "wrist", kWrists, where);
  if (!wrist) return pass(wrist);
  asked.wrist = *wrist;
  for (const Flag& flag : kFlags) {
    const std::string name(flag.name);
    if (!fields.contains(name)) continue;
    if (!fields[name].is_boolean())
      return tl::unexpected<Error>(wrong(where, name, "must be true or false"));
    asked.*flag.field = fields[name].get<bool>();
  }
  return asked;
}

Asked merged(const Asked& under, const Asked& over) {
  Asked out = over;
  if (!out.load_kg) out.load_kg = under.load_kg;
  if (!out.coupling) out.coupling = under.coupling;
  if (!out.wrist) out.wrist = under.wrist;
  for (const Flag& flag : kFlags) {
    if (!(out.*flag.field)) out.*flag.field = under.*flag.field;
  }
  return out;
}

}  // namespace chorus::ergonomics
