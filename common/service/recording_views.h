// Looking at recordings over HTTP: /recordings/{name}/outline, /stretch?from=&to=&every=,
// /frame?at=, /marks, and POST /recordings/{name}/cut, which makes a new recording of a part.
//
// Reading happens on the server's thread: a stretch is at most five seconds and about a megabyte,
// and the files stay open while somebody looks.  1.45 MB took 65 ms, most requests take a few
// milliseconds.  Cutting has a thread of its own, which ends early when the service stops.
//
// Marks are kept beside the recording in marks.json; while the recording runs, a mark is set at the
// present and is written into its files as well (record/marks.h).  While marks.json cannot be read,
// nothing is marked there, so that what is in it stays.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "common/http/router.h"
#include "common/record/recording_index.h"
#include "common/record/recording_view.h"

namespace chorus::service {

struct RecordingViewsOptions {
  /// The files of a recording that can be read; an error otherwise.
  std::function<Result<std::vector<std::filesystem::path>>(const std::string& name)> files_of;
  /// The folder in which each recording has a folder; empty: nothing can be marked or cut.
  std::filesystem::path folder;
  /// Writes a mark into the recording of this name, at the present, if it runs: how long after its
  /// beginning that was [s].  None: it does not run.
  std::function<Result<std::optional<double>>(const std::string& name, const std::string& text)>
      mark_running = [](const auto&, const auto&) { return std::nullopt; };
  std::uintmax_t min_free_bytes = 0;  ///< A cut ends when less than this is free.
  /// Called with a new recording that a cut has made.
  std::function<void(const record::RecordingReport&)> made = [](const auto&) {};
  std::string run;  ///< See Serving::run.
};

/// One place in a recording that somebody named.
struct Mark {
  int id = 0;
  double seconds = 0.0;
  std::string text;

  bool operator==(const Mark&) const = default;
};

/// Reads {"seconds": 12.4, "text": "..."}: at most 200 characters of UTF-8 without control
/// characters; the id is 0.  Without seconds, which is for the present, they are NaN.
[[nodiscard]] Result<Mark> parse_mark(std::string_view body);

/// The marks in a marks.json, in the order of time.  No file: no marks.  Conflict when the file
/// cannot be read, because it must not be replaced then.
[[nodiscard]] Result<std::vector<Mark>> stored_marks(const std::filesystem::path& file);

/// What is asked of a cut: {"from": 3, "to": 8.5, "name": "walk-2"}.
struct CutRequest {
  double from = 0.0;
  double to = 0.0;
  std::string name;
};
[[nodiscard]] Result<CutRequest> parse_cut(std::string_view body);

/// Thread-safe.
class RecordingViews {
 public:
  explicit RecordingViews(RecordingViewsOptions options) : options_(std::move(options)) {}

  /// The router keeps using this object, which must outlive the router.
  void add_routes(http::Router& router);

 private:
  struct CutState {
    std::string name;
    std::string trouble;  ///< Empty while it runs.
  };

  [[nodiscard]] Result<record::RecordingView*> view_of(const std::string& name);
  [[nodiscard]] Result<http::DocumentPtr> outline(const std::string& name);
  [[nodiscard]] Result<http::DocumentPtr> stretch(const std::string& name,
                                                  const http::Request& request);
  [[nodiscard]] Result<http::DocumentPtr> frame(const std::string& name,
                                                const http::Request& request);
  [[nodiscard]] Result<http::DocumentPtr> marks(const std::string& name);
  [[nodiscard]] Result<http::ActionResult> mark(const std::string& name, std::string_view body);
  [[nodiscard]] Result<http::ActionResult> keep(const std::string& name, Mark mark);
  [[nodiscard]] Result<http::ActionResult> unmark(const std::string& name, const std::string& id);
  [[nodiscard]] Result<http::ActionResult> cut(const std::string& name, std::string_view body);
  [[nodiscard]] Result<std::filesystem::path> marks_file(const std::string& name) const;
  struct CutJob {
    std::string source;
    CutRequest request;
    record::Cut cut;
    std::vector<std::filesystem::path> files;
  };
  [[nodiscard]] Result<record::Cut> cut_of(const CutRequest& wish,
                                           const record::RecordingView& view) const;
  void run_cut(const CutJob& job, const std::stop_token& stop);
  [[nodiscard]] http::DocumentPtr document(std::string json) const;

  const RecordingViewsOptions options_;
  std::mutex mutex_;  ///< Guards the members below.
  std::string open_;  ///< The recording that `view_` shows.
  std::unique_ptr<record::RecordingView> view_;
  std::map<std::string, CutState> cuts_;  ///< By the recording that was cut.
  bool cutting_ = false;
  std::jthread cutter_;  ///< The last member: it uses the others.
};

}  // namespace chorus::service
