#include "fusion-server/learn/boosting.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/json.h"

namespace chorus::learn {
namespace {

using nlohmann::json;

constexpr const char* kLibrary = "libxgboost.so.0";
constexpr int kTrees = 30;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr int kMargin = 1;                // XGBoosterPredict: sums before the link
constexpr double kSameSum = 1e-3;         // sums are of single precision
constexpr std::size_t kMostNodes = 1000;  // of one tree; trees of this depth are far smaller

using Handle = void*;
using Length = std::uint64_t;

/// The part of XGBoost's C interface that training needs; 0 is success.
struct Calls {
  int (*matrix)(const float* rows, Length count, Length columns, float missing, Handle* out);
  int (*free_matrix)(Handle matrix);
  int (*set_floats)(Handle matrix, const char* field, const float* values, Length count);
  int (*booster)(const Handle* matrices, Length count, Handle* out);
  int (*free_booster)(Handle booster);
  int (*set)(Handle booster, const char* name, const char* value);
  int (*update)(Handle booster, int round, Handle matrix);
  int (*predict)(Handle booster, Handle matrix, int options, unsigned trees, int training,
                 Length* count, const float** sums);
  int (*dump)(Handle booster, const char* names, int statistics, const char* format, Length* count,
              const char*** trees);
  const char* (*last_error)();
};

template <class Call>
bool find(void* library, const char* name, Call& call) {
  call = reinterpret_cast<Call>(dlsym(library, name));
  return call != nullptr;
}

/// Null if the library is not installed, or lacks a function.  It stays loaded.
const Calls* loaded() {
  static const std::unique_ptr<const Calls> kCalls = []() -> std::unique_ptr<const Calls> {
    void* const library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return nullptr;
    auto calls = std::make_unique<Calls>();
    const bool all = find(library, "XGDMatrixCreateFromMat", calls->matrix) &&
                     find(library, "XGDMatrixFree", calls->free_matrix) &&
                     find(library, "XGDMatrixSetFloatInfo", calls->set_floats) &&
                     find(library, "XGBoosterCreate", calls->booster) &&
                     find(library, "XGBoosterFree", calls->free_booster) &&
                     find(library, "XGBoosterSetParam", calls->set) &&
                     find(library, "XGBoosterUpdateOneIter", calls->update) &&
                     find(library, "XGBoosterPredict", calls->predict) &&
                     find(library, "XGBoosterDumpModelEx", calls->dump) &&
                     find(library, "XGBGetLastError", calls->last_error);
    if (!all) return nullptr;
    return calls;
  }();
  return kCalls.get();
}

tl::unexpected<Error> refused(const Calls& calls) {
  return fail(ErrorCode::Internal, "XGBoost", calls.last_error());
}

/// Samples and booster of one joint.
class Training {
 public:
  explicit Training(const Calls& calls) : calls_(calls) {}
  ~Training() {
    if (booster_ != nullptr) calls_.free_booster(booster_);
    if (matrix_ != nullptr) calls_.free_matrix(matrix_);
  }
  Training(const Training&) = delete;
  Training& operator=(const Training&) = delete;

  /// `errors`: in units of their mean, which is what boosting starts from.
  Result<void> run(std::span<const fusion::Features> features, const std::vector<float>& errors) {
    std::vector<float> rows;
    for (const fusion::Features& each : features) rows.insert(rows.end(), each.begin(), each.end());
    const std::array<std::pair<const char*, const char*>, 8> settings{{{"objective", "reg:gamma"},
                                                                       {"base_score", "1"},
                                                                       {"eta", "0.2"},
                                                                       {"max_depth", "4"},
                                                                       {"min_child_weight", "20"},
                                                                       {"tree_method", "hist"},
                                                                       {"nthread", "1"},
                                                                       {"verbosity", "0"}}};
    bool ok = calls_.matrix(rows.data(), features.size(), fusion::kFeatureCount, kUnknown,
                            &matrix_) == 0 &&
              calls_.set_floats(matrix_, "label", errors.data(), errors.size()) == 0 &&
              calls_.booster(&matrix_, 1, &booster_) == 0;
    for (const auto& [name, value] : settings) ok = ok && calls_.set(booster_, name, value) == 0;
    for (int round = 0; ok && round < kTrees; ++round)
      ok = calls_.update(booster_, round, matrix_) == 0;
    if (!ok) return refused(calls_);
    return {};
  }

  /// XGBoost's own sums, one for each sample.
  [[nodiscard]] Result<std::vector<float>> sums() const {
    Length count = 0;
    const float* first = nullptr;
    if (calls_.predict(booster_, matrix_, kMargin, 0, 0, &count, &first) != 0)
      return refused(calls_);
    return std::vector<float>(first, first + count);
  }

  [[nodiscard]] Result<std::vector<std::string>> trees() const {
    Length count = 0;
    const char** first = nullptr;
    if (calls_.dump(booster_, "", 0, "json", &count, &first) != 0) return refused(calls_);
    return std::vector<std::string>(first, first + count);
  }

 private:
  const Calls& calls_;
  Handle matrix_ = nullptr;
  Handle booster_ = nullptr;
};

/// Adds a node and those below it; returns its index, or none if the dump has an unknown form.
std::optional<int> add_node(const json& dumped, fusion::ErrorTree& tree) {
  if (tree.size() >= kMostNodes || !dumped.is_object()) return std::nullopt;
  const auto at = tree.size();
  tree.emplace_back();
  if (dumped.contains("leaf")) {
    tree[at].value = dumped["leaf"].get<double>();
    return static_cast<int>(at);
  }
  const std::string split = dumped.at("split").get<std::string>();  // "f3"
  const std::size_t feature = std::stoul(split.substr(1));
  if (feature >= fusion::kFeatureCount) return std::nullopt;
  const auto& children = dumped.at("children");
  const bool in_order = children.at(0).at("nodeid") == dumped.at("yes");
  const auto yes = add_node(children.at(in_order ? 0 : 1), tree);
  const auto no = add_node(children.at(in_order ? 1 : 0), tree);
  if (!yes || !no) return std::nullopt;
  tree[at] = {static_cast<int>(feature), dumped.at("split_condition").get<double>(), *yes, *no,
              dumped.at("missing") == dumped.at("yes")};
  return static_cast<int>(at);
}

Result<fusion::ErrorTree> tree_of(const std::string& dumped) {
  const auto parsed = parse_json(dumped);
  if (!parsed) return pass(parsed);
  fusion::ErrorTree tree;
  try {
    if (add_node(*parsed, tree)) return tree;
  } catch (const std::exception&) {  // of nlohmann and stoul
  }
  return fail(ErrorCode::Unsupported, kLibrary, "describes its trees in an unknown way");
}

/// Sets the constant, and checks that our evaluation of the trees agrees with XGBoost's.
Result<void> compare(Boosted& boosted, std::span<const fusion::Features> features,
                     const std::vector<float>& sums) {
  fusion::ErrorPredictor ours;
  fusion::JointPredictor joint;
  joint.trees = boosted.trees;
  for (std::size_t i = 0; i < features.size() && i < sums.size(); ++i) {
    const double off = static_cast<double>(sums[i]) - linear_sum(ours, joint, features[i]);
    if (i == 0) boosted.constant = off;
    if (!(std::abs(off - boosted.constant) < kSameSum))
      return fail(ErrorCode::Internal, kLibrary,
                  fmt::format("and our reading of its trees differ by {} at sample {}",
                              off - boosted.constant, i));
  }
  return {};
}

}  // namespace

bool can_boost() { return loaded() != nullptr; }

Result<Boosted> boost_errors(std::span<const fusion::Features> features,
                             std::span<const double> errors) {
  const Calls* const calls = loaded();
  if (calls == nullptr)
    return fail(ErrorCode::Unavailable, kLibrary,
                "is not installed, and boosting is trained with it: apt install libxgboost0, or "
                "choose another model");
  double mean = 0.0;
  for (const double error : errors) mean += error / static_cast<double>(errors.size());
  std::vector<float> relative;
  for (const double error : errors) relative.push_back(static_cast<float>(error / mean));
  Training training(*calls);
  if (auto ok = training.run(features, relative); !ok) return pass(ok);
  const auto dumped = training.trees();
  if (!dumped) return pass(dumped);
  Boosted boosted;
  for (const std::string& each : *dumped) {
    auto tree = tree_of(each);
    if (!tree) return pass(tree);
    boosted.trees.push_back(std::move(*tree));
  }
  const auto sums = training.sums();
  if (!sums) return pass(sums);
  if (auto ok = compare(boosted, features, *sums); !ok) return pass(ok);
  return boosted;
}

}  // namespace chorus::learn
