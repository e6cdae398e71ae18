#include "services/ctl/convert/fused_file.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <system_error>
#include <utility>

#include "common/base/file.h"
#include "common/record/cell_writer.h"
#include "common/record/fused_frames.h"
#include "fusion-server/wire/registration_file.h"
#include "fusion-server/wire/snapshot_resource.h"
#include "services/ctl/line/text_file.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

/// A temporary file next to the target; removed unless it replaces the target.
class Partial {
 public:
  explicit Partial(std::string file) : file_(std::move(file)), path_(file_ + ".partial") {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  ~Partial() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  Partial(const Partial&) = delete;
  Partial& operator=(const Partial&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] Result<void> take_place() const {
    // Another process may have created the file.
    if (auto ok = may_write(file_, {}); !ok) return ok;
    std::error_code error;
    fs::rename(path_, file_, error);
    if (error) return fail(ErrorCode::Io, file_, error.message());
    sync_folder(fs::path(file_).parent_path());
    return {};
  }

 private:
  std::string file_;
  std::string path_;
};

/// A recording that holds only the fused frames.
class FusedRecording final : public FusedFile {
 public:
  FusedRecording(const std::string& file, Registration registration)
      : partial_(file), registration_(std::move(registration)) {}

  Result<void> begin() {
    auto writer = record::CellWriter::create(partial_.path(), {{{"title", "chorus fuse"}}, false});
    if (!writer) return pass(writer);
    writer_.emplace(std::move(*writer));
    return {};
  }
  Result<void> add(const Snapshot& snapshot) override {
    if (auto ok = write_places(snapshot.instant); !ok) return ok;
    return writer_->write(record::FusedFrame{snapshot.instant, snapshot.instant,
                                             [&] { return wire::to_resource(snapshot); }});
  }
  Result<void> finish() override {
    if (auto ok = write_places(Timestamp{}); !ok) return ok;
    if (auto ok = writer_->close(); !ok) return ok;
    return partial_.take_place();
  }

 private:
  Result<void> write_places(Timestamp begin) {
    if (placed_) return {};
    placed_ = true;
    return writer_->write(wire::places_changed(begin, registration_));
  }

  Partial partial_;
  Registration registration_;
  std::optional<record::CellWriter> writer_;
  bool placed_ = false;
};

}  // namespace

class FrameLines::Impl {
 public:
  explicit Impl(const std::string& file) : file_(file) {}

  Result<void> begin() {
    std::error_code ignored;
    if (file_ == "-") return {};
    const fs::path folder = fs::path(file_).parent_path();
    if (!folder.empty() && !fs::is_directory(folder, ignored))
      return fail(ErrorCode::Io, file_, "cannot be written; is its folder there?");
    // A pipe or a device is written to directly.
    const bool plain = !fs::exists(file_, ignored) || fs::is_regular_file(file_, ignored);
    if (plain) partial_.emplace(file_);
    out_.open(plain ? partial_->path() : file_, std::ios::binary | std::ios::trunc);
    return judged();
  }
  Result<void> add(const resource::FrameResource& frame) {
    stream() << record::frame_line(frame);
    return judged();
  }
  Result<void> finish() {
    stream().flush();
    if (auto ok = judged(); !ok) return ok;
    if (out_.is_open()) out_.close();
    return partial_ ? partial_->take_place() : Result<void>{};
  }

 private:
  std::ostream& stream() { return file_ == "-" ? std::cout : out_; }
  Result<void> judged() {
    if (stream()) return {};
    if (file_ == "-") return fail(ErrorCode::Io, "standard output", "cannot be written.");
    return fail(ErrorCode::Io, file_, "cannot be written.");
  }

  std::string file_;
  std::optional<Partial> partial_;
  std::ofstream out_;
};

FrameLines::FrameLines(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameLines::FrameLines(FrameLines&&) noexcept = default;
FrameLines::~FrameLines() = default;

Result<FrameLines> FrameLines::create(const std::string& file) {
  auto impl = std::make_unique<Impl>(file);
  if (auto ok = impl->begin(); !ok) return pass(ok);
  return FrameLines(std::move(impl));
}

Result<void> FrameLines::add(const resource::FrameResource& frame) { return impl_->add(frame); }
Result<void> FrameLines::finish() { return impl_->finish(); }

namespace {

class FusedLines final : public FusedFile {
 public:
  explicit FusedLines(const std::string& file) : file_(file) {}

  Result<void> begin() {
    auto lines = FrameLines::create(file_);
    if (!lines) return pass(lines);
    lines_.emplace(std::move(*lines));
    return {};
  }
  Result<void> add(const Snapshot& snapshot) override {
    return lines_->add(wire::to_resource(snapshot));
  }
  Result<void> finish() override { return lines_->finish(); }

 private:
  std::string file_;
  std::optional<FrameLines> lines_;
};

template <class File>
Result<std::unique_ptr<FusedFile>> begun(std::unique_ptr<File> file) {
  if (auto ok = file->begin(); !ok) return pass(ok);
  return std::unique_ptr<FusedFile>(std::move(file));
}

}  // namespace

Result<std::unique_ptr<FusedFile>> create_fused_file(const std::string& file,
                                                     const Registration& registration) {
  if (file.ends_with(".mcap")) return begun(std::make_unique<FusedRecording>(file, registration));
  return begun(std::make_unique<FusedLines>(file));
}

}  // namespace chorus::ctl
