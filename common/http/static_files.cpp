#include "common/http/static_files.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <system_error>

namespace chorus::http {
namespace fs = std::filesystem;
namespace {

struct ExtensionRow {
  std::string_view extension;
  std::string_view media_type;
};

constexpr std::array kExtensions{
    ExtensionRow{".html", "text/html"},
    ExtensionRow{".js", "text/javascript"},
    ExtensionRow{".mjs", "text/javascript"},
    ExtensionRow{".css", "text/css"},
    ExtensionRow{".json", "application/json"},
    ExtensionRow{".map", "application/json"},
    ExtensionRow{".ttl", "text/turtle"},
    ExtensionRow{".txt", "text/plain"},
    ExtensionRow{".md", "text/markdown; charset=utf-8"},
    ExtensionRow{".svg", "image/svg+xml"},
    ExtensionRow{".png", "image/png"},
    ExtensionRow{".jpg", "image/jpeg"},
    ExtensionRow{".jpeg", "image/jpeg"},
    ExtensionRow{".ico", "image/vnd.microsoft.icon"},
    ExtensionRow{".wasm", "application/wasm"},
    ExtensionRow{".woff2", "font/woff2"},
    ExtensionRow{".glb", "model/gltf-binary"},
    ExtensionRow{".webmanifest", "application/manifest+json"},
};

struct FileState {
  std::int64_t modified_ns = 0;
  std::uintmax_t size = 0;
  bool operator==(const FileState&) const = default;
};

/// NotFound if it is not a regular file: a FIFO would block its reader forever.
Result<FileState> state_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
    return fail(ErrorCode::NotFound, file.filename().string(), "there is no such file");
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  return FileState{status.st_mtim.tv_sec * kNsPerSecond + status.st_mtim.tv_nsec,
                   static_cast<std::uintmax_t>(status.st_size)};
}

bool is_inside(const fs::path& file, const fs::path& folder) {
  const auto [in_folder, in_file] =
      std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return in_folder == folder.end() && in_file != file.end();
}

Result<std::string> read_file(const fs::path& file, std::uintmax_t size) {
  std::string bytes(size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!in)
    return fail(ErrorCode::Io, file.filename().string(), "the file cannot be read to its end");
  return bytes;
}

}  // namespace

std::string_view media_type_of_file(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  const std::string_view extension =
      dot == std::string_view::npos ? std::string_view() : name.substr(dot);
  const auto row = std::find_if(kExtensions.begin(), kExtensions.end(),
                                [&](const ExtensionRow& e) { return e.extension == extension; });
  return row == kExtensions.end() ? "application/octet-stream" : row->media_type;
}

struct StaticFiles::Impl {
  struct Kept {
    FileState state;
    DocumentPtr document;
  };
  fs::path folder;
  FilesAre about;
  std::mutex mutex;
  std::map<std::string, Kept> kept;

  [[nodiscard]] Result<fs::path> resolve(std::string_view path) const {
    std::string name(path);
    if (name.empty() || name.back() == '/') name += "index.html";
    std::error_code failed;
    const fs::path root = fs::canonical(folder, failed);
    const fs::path file = failed ? fs::path() : fs::canonical(root / name, failed);
    // A leading '/' would make root / name absolute; is_inside refuses that as well.
    if (failed || !is_inside(file, root))
      return fail(ErrorCode::NotFound, std::string(path), "there is no such file");
    return file;
  }

  [[nodiscard]] Result<DocumentPtr> load(const fs::path& file, const FileState& state) const {
    auto bytes = read_file(file, state.size);
    if (!bytes) return pass(bytes);
    DocumentOptions options;
    options.page = about.page;
    if (about.page && is_page(media_type_of_file(file.filename().string())))
      options.import_map = import_map_of(*bytes);
    options.version = std::to_string(state.modified_ns) + "-" + std::to_string(state.size);
    std::vector<Variant> variants;
    variants.push_back({std::string(media_type_of_file(file.filename().string())),
                        [text = std::move(*bytes)] { return text; }});
    variants.back().lines = about.lines;
    return std::make_shared<const Document>(std::move(variants), std::move(options));
  }
};

StaticFiles::StaticFiles(std::string folder, const FilesAre& about)
    : impl_(std::make_unique<Impl>()) {
  impl_->folder = std::move(folder);
  impl_->about = about;
}

StaticFiles::~StaticFiles() = default;

Result<DocumentPtr> StaticFiles::document(std::string_view path) {
  const auto file = impl_->resolve(path);
  if (!file) return pass(file);
  const auto state = state_of(*file);
  if (!state) return pass(state);
  if (state->size > impl_->about.max_bytes)
    return fail(ErrorCode::Forbidden, std::string(path),
                "the file is larger than the " + std::to_string(impl_->about.max_bytes) +
                    " bytes this server sends");
  const std::lock_guard lock(impl_->mutex);
  auto& entry = impl_->kept[file->string()];
  if (entry.document && entry.state == *state) return entry.document;
  auto loaded = impl_->load(*file, *state);
  if (!loaded) return loaded;
  entry = {*state, *loaded};
  return entry.document;
}

}  // namespace chorus::http
