#include "fusion-server/learn/error_file.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/file.h"
#include "common/base/json.h"
#include "common/body/bones.h"

namespace chorus::learn {
namespace {

using fusion::ErrorPredictor;
using fusion::ErrorTree;
using fusion::FeatureRange;
using fusion::Features;
using fusion::JointPredictor;
using fusion::kFeatureCount;
using fusion::kFeatureNames;
using fusion::PredictorKind;
using fusion::TreeNode;
using nlohmann::json;

constexpr const char* kFormat = "chorus-error-model";
constexpr int kVersion = 1;
constexpr std::size_t kMostBytes = 16'000'000;
constexpr double kMostNumber = 1e6;       // no coefficient or feature is near it
constexpr double kMostRms = 100.0;        // of an error in units of the predicted one
constexpr std::size_t kMostTrees = 2000;  // of one joint
constexpr std::size_t kMostTreeNodes = 10'000;

template <class T>
using Parsed = Result<T>;

tl::unexpected<Error> wrong(std::string where, std::string what) {
  return fail(ErrorCode::Malformed, std::move(where),
              std::move(what) + "; train the model again with `chorus train-error`");
}

/// A member that is a finite number in the interval.
Parsed<double> number(const json& object, const std::string& at, const char* key, double least,
                      double most) {
  const auto found = object.find(key);
  if (found != object.end() && found->is_number()) {
    const double value = found->get<double>();
    if (value >= least && value <= most) return value;
  }
  return wrong(at + "." + key, fmt::format("must be a number from {} to {}", least, most));
}

Parsed<const json*> object_at(const json& parent, const std::string& at, const char* key) {
  const auto found = parent.find(key);
  if (found == parent.end() || !found->is_object())
    return wrong(at.empty() ? key : at + "." + key, "must be an object");
  return &*found;
}

json json_of(const ErrorTree& tree) {
  json nodes = json::array();
  for (const TreeNode& node : tree) {
    if (node.feature < 0) {
      nodes.push_back(json::array({node.value}));
    } else {
      nodes.push_back(
          json::array({node.feature, node.value, node.yes, node.no, node.unknown_yes ? 1 : 0}));
    }
  }
  return nodes;
}

json json_of(const JointPredictor& joint, PredictorKind kind) {
  json out{{"rms", joint.rms},
           {"least", joint.least},
           {"most", joint.most},
           {"constant", joint.constant}};
  if (kind == PredictorKind::Boosting) {
    json trees = json::array();
    for (const ErrorTree& tree : joint.trees) trees.push_back(json_of(tree));
    out["trees"] = std::move(trees);
    return out;
  }
  json coefficients = json::object();
  for (std::size_t f = 0; f < kFeatureCount; ++f) {
    if (joint.coefficients[f] != 0.0)
      coefficients[std::string(kFeatureNames[f])] = joint.coefficients[f];
  }
  out["coefficients"] = std::move(coefficients);
  return out;
}

/// The feature's index; an error names all features.
Parsed<std::size_t> feature_named(const std::string& name, const std::string& at) {
  const auto* const found = std::ranges::find(kFeatureNames, name);
  if (found != kFeatureNames.end()) return static_cast<std::size_t>(found - kFeatureNames.begin());
  return wrong(at, fmt::format("has the unknown feature '{}'", name.substr(0, 40)));
}

Parsed<std::array<FeatureRange, kFeatureCount>> read_ranges(const json& root) {
  const auto object = object_at(root, "", "features");
  if (!object) return pass(object);
  std::array<FeatureRange, kFeatureCount> ranges;
  for (const auto& [name, value] : (*object)->items()) {
    const std::string at = "features." + name.substr(0, 40);
    const auto feature = feature_named(name, "features");
    if (!feature) return pass(feature);
    const auto least = number(value, at, "least", -kMostNumber, kMostNumber);
    if (!least) return pass(least);
    const auto most = number(value, at, "most", *least, kMostNumber);
    if (!most) return pass(most);
    const auto mean = number(value, at, "mean", *least, *most);
    if (!mean) return pass(mean);
    ranges[*feature] = {*least, *most, *mean};
  }
  return ranges;
}

Parsed<TreeNode> read_node(const json& value, const std::string& at, std::size_t index,
                           std::size_t count) {
  const auto numeric = [](const json& each) {
    return each.is_number() && std::abs(each.get<double>()) <= kMostNumber;
  };
  if (!value.is_array() || !std::ranges::all_of(value, numeric) ||
      (value.size() != 1 && value.size() != 5))
    return wrong(at, "must be [value] or [feature, value, yes, no, unknownYes]");
  if (value.size() == 1) return TreeNode{-1, value[0].get<double>()};
  const auto whole = [&](std::size_t i, std::size_t least,
                         std::size_t below) -> std::optional<int> {
    if (!value[i].is_number_integer()) return std::nullopt;
    const auto n = value[i].get<std::int64_t>();
    if (n < static_cast<std::int64_t>(least) || n >= static_cast<std::int64_t>(below))
      return std::nullopt;
    return static_cast<int>(n);
  };
  const auto feature = whole(0, 0, kFeatureCount);
  const auto yes = whole(2, index + 1, count);
  const auto no = whole(3, index + 1, count);
  const auto unknown = whole(4, 0, 2);
  if (!feature || !yes || !no || !unknown)
    return wrong(at, "names a feature or a node that does not exist, or a node above it");
  return TreeNode{*feature, value[1].get<double>(), *yes, *no, *unknown == 1};
}

Parsed<std::vector<ErrorTree>> read_trees(const json& joint, const std::string& at) {
  const auto found = joint.find("trees");
  if (found == joint.end() || !found->is_array() || found->size() > kMostTrees)
    return wrong(at + ".trees", fmt::format("must be an array of at most {} trees", kMostTrees));
  std::vector<ErrorTree> trees;
  for (const json& nodes : *found) {
    const std::string tree_at = fmt::format("{}.trees.{}", at, trees.size());
    if (!nodes.is_array() || nodes.empty() || nodes.size() > kMostTreeNodes)
      return wrong(tree_at, fmt::format("must be an array of 1 to {} nodes", kMostTreeNodes));
    ErrorTree tree;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto node = read_node(nodes[i], fmt::format("{}.{}", tree_at, i), i, nodes.size());
      if (!node) return pass(node);
      tree.push_back(*node);
    }
    trees.push_back(std::move(tree));
  }
  return trees;
}

Parsed<Features> read_coefficients(const json& joint, const std::string& at) {
  const auto object = object_at(joint, at, "coefficients");
  if (!object) return pass(object);
  Features coefficients = {};
  for (const auto& [name, value] : (*object)->items()) {
    const auto feature = feature_named(name, at + ".coefficients");
    if (!feature) return pass(feature);
    const auto coefficient =
        number(**object, at + ".coefficients", name.c_str(), -kMostNumber, kMostNumber);
    if (!coefficient) return pass(coefficient);
    coefficients[*feature] = *coefficient;
  }
  return coefficients;
}

Parsed<JointPredictor> read_joint(const json& value, const std::string& at, PredictorKind kind) {
  if (!value.is_object()) return wrong(at, "must be an object");
  JointPredictor joint;
  const auto rms = number(value, at, "rms", 0.0, kMostRms);
  if (!rms) return pass(rms);
  const auto constant = number(value, at, "constant", -kMostNumber, kMostNumber);
  if (!constant) return pass(constant);
  joint.rms = *rms;
  const auto least = number(value, at, "least", fusion::kLeastPrediction, fusion::kMostPrediction);
  if (!least) return pass(least);
  const auto most = number(value, at, "most", *least, fusion::kMostPrediction);
  if (!most) return pass(most);
  joint.least = *least;
  joint.most = *most;
  joint.constant = *constant;
  if (kind == PredictorKind::Boosting) {
    auto trees = read_trees(value, at);
    if (!trees) return pass(trees);
    joint.trees = std::move(*trees);
    return joint;
  }
  const auto coefficients = read_coefficients(value, at);
  if (!coefficients) return pass(coefficients);
  joint.coefficients = *coefficients;
  return joint;
}

Parsed<void> read_joints(const json& root, ErrorPredictor& out) {
  const auto joints = object_at(root, "", "joints");
  if (!joints) return pass(joints);
  for (const auto& [name, value] : (*joints)->items()) {
    const std::string at = "joints." + name.substr(0, 40);
    const auto id = joint_named(name);
    if (!id) return wrong(at, "is not one of our joints");
    auto joint = read_joint(value, at, out.kind);
    if (!joint) return pass(joint);
    out.joints[index_of(*id)] = std::move(*joint);
  }
  if ((*joints)->empty()) return wrong("joints", "must not be empty");
  return {};
}

Parsed<PredictorKind> read_head(const json& root) {
  if (!root.is_object() || root.value("format", json()) != kFormat)
    return fail(ErrorCode::Malformed, "format",
                fmt::format("must be \"{}\": this is no file of `chorus train-error`", kFormat));
  if (root.value("version", json()) != kVersion)
    return fail(ErrorCode::Unsupported, "version",
                fmt::format("must be {}: train the model again with this version", kVersion));
  const json kind = root.value("kind", json());
  const auto* const found = std::ranges::find_if(
      fusion::kPredictorNames, [&](std::string_view name) { return kind == name; });
  if (found == fusion::kPredictorNames.end())
    return wrong("kind", "must be constant, states, linear, gamma or boosting");
  return static_cast<PredictorKind>(found - fusion::kPredictorNames.begin());
}

}  // namespace

std::string write_predictor(const ErrorPredictor& predictor) {
  json features = json::object();
  for (std::size_t f = 0; f < kFeatureCount; ++f) {
    const FeatureRange& range = predictor.ranges[f];
    features[std::string(kFeatureNames[f])] = {
        {"least", range.least}, {"most", range.most}, {"mean", range.mean}};
  }
  json joints = json::object();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (const auto& joint = predictor.joints[j])
      joints[std::string(kJointNames[j])] = json_of(*joint, predictor.kind);
  }
  const auto kind = fusion::kPredictorNames[static_cast<std::size_t>(predictor.kind)];
  const json root{{"format", kFormat},
                  {"version", kVersion},
                  {"kind", std::string(kind)},
                  {"trainedOn", predictor.trained_on},
                  {"features", std::move(features)},
                  {"joints", std::move(joints)}};
  return root.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

Result<ErrorPredictor> read_predictor(std::string_view text) {
  const auto root = parse_json(text, {.bytes = kMostBytes});
  if (!root) return pass(root);
  const auto kind = read_head(*root);
  if (!kind) return pass(kind);
  ErrorPredictor predictor;
  predictor.kind = *kind;
  if (const json from = root->value("trainedOn", json()); from.is_string())
    predictor.trained_on = from.get<std::string>();
  const auto ranges = read_ranges(*root);
  if (!ranges) return pass(ranges);
  predictor.ranges = *ranges;
  if (auto ok = read_joints(*root, predictor); !ok) return pass(ok);
  return predictor;
}

Result<fusion::SharedPredictor> load_predictor(const std::filesystem::path& file) {
  const auto text = read_file(file, kMostBytes);
  if (!text) return pass(text);
  auto predictor = read_predictor(*text);
  if (!predictor) {
    const Error& error = predictor.error();
    return fail(error.code, file.string(), to_string(error));
  }
  return fusion::SharedPredictor{std::make_shared<const ErrorPredictor>(std::move(*predictor))};
}

}  // namespace chorus::learn
