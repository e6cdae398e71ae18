#include "common/service/recordings.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include "common/base/log.h"
#include "common/base/parse.h"
#include "common/http/status.h"
#include "common/resource/link_lines.h"

namespace chorus::service {
namespace {

namespace fs = std::filesystem;

using record::RecordingReport;
using record::RecordingState;
using resource::Ref;

constexpr std::string_view kWhere = "recordings";
constexpr std::string_view kSuffix = ".mcap";
constexpr std::size_t kMaxListed = 10'000;

bool is_running(const RecordingReport& report) {
  return report.state == RecordingState::Recording || report.state == RecordingState::Stopping;
}

/// The folder's recordings from earlier runs.
std::map<std::string, RecordingReport> recordings_in(const fs::path& folder) {
  std::map<std::string, RecordingReport> found;
  std::error_code error;
  if (folder.empty()) return found;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (found.size() >= kMaxListed || !record::is_recording_name(name)) continue;
    if (auto report = record::read_index(it->path())) found.emplace(name, std::move(*report));
  }
  return found;
}

std::string version_of(const RecordingReport& report) {
  return report.name + "-" + std::string(name_of(report.state)) + "-" +
         std::to_string(report.frames) + "-" + std::to_string(report.dropped) + "-" +
         std::to_string(report.bytes());
}

/// The error for a recording that did not start; it does not reveal this host's paths.
tl::unexpected<Error> refused(const Error& error, const std::string& name) {
  const std::string where = std::string(kWhere) + "/" + name;
  if (error.code == ErrorCode::Conflict)
    return fail(error.code, where,
                "there is a recording of this name already: choose another `name`");
  const std::string full = std::generic_category().message(ENOSPC);
  if (error.message.find(full) != std::string::npos)
    return fail(ErrorCode::Unavailable, where, "the disk of this service is full: make room on it");
  return fail(error.code, where, error.message);
}

/// The part of the list that one request asks for.
struct Page {
  std::string after;  ///< Names up to and including this one are left out.
  std::size_t limit = 100;
};

Result<Page> page_of(const http::Request& request) {
  Page page;
  constexpr std::size_t kMax = 1000;
  if (const auto after = request.query.find("after"); after != request.query.end())
    page.after = after->second;
  const auto limit = request.query.find("limit");
  if (limit == request.query.end()) return page;
  const std::string& text = limit->second;
  const auto number = parse_number<std::size_t>(text);
  page.limit = number.value_or(0);
  if (page.limit >= 1 && page.limit <= kMax) return page;
  return fail(
      ErrorCode::InvalidArgument, "limit",
      "a whole number from 1 to " + std::to_string(kMax) + ", not '" + text.substr(0, 32) + "'");
}

}  // namespace

void read_recording(ConfigReader config, RecordingConfig& out) {
  constexpr double kMegabyte = 1u << 20;
  constexpr double kMax = 1e6;  // [MB]
  const auto read_mb = [&](std::string_view key, std::uintmax_t& bytes, double least) {
    double megabytes = static_cast<double>(bytes) / kMegabyte;
    config.read(key, megabytes, least, kMax);
    bytes = static_cast<std::uintmax_t>(megabytes * kMegabyte);
  };
  config.read("folder", out.folder);
  read_mb("max_file_mb", out.limits.max_file_bytes, 1.0);
  config.read_s("max_file_s", out.limits.max_file_duration, std::chrono::seconds(1),
                std::chrono::hours(24));
  read_mb("min_free_mb", out.limits.min_free_bytes, 0.0);
}

resource::Node recording_node(const RecordingReport& report, std::string id) {
  resource::Node node{std::move(id), {"Recording"}, {}};
  auto& out = node.properties;
  const auto count = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
  const std::string folder = "/recordings/" + report.name;
  out.emplace_back("name", report.name);
  out.emplace_back("state", std::string(name_of(report.state)));
  if (!report.reason.empty()) out.emplace_back("reasons", std::vector<std::string>{report.reason});
  out.emplace_back("started", report.started);
  if (report.stopped) out.emplace_back("stopped", *report.stopped);
  out.emplace_back("bytes", count(report.bytes()));
  out.emplace_back("frames", count(report.frames));
  out.emplace_back("dropped", count(report.dropped));
  if (report.files.size() == 1) out.emplace_back("download", Ref{folder + std::string(kSuffix)});
  std::vector<Ref> files;
  for (const record::RecordedFile& file : report.files) files.push_back({folder + "/" + file.name});
  out.emplace_back("files", std::move(files));
  return node;
}

Recordings::Recordings(RecordingsOptions options)
    : options_(std::move(options)), ended_(recordings_in(options_.config.folder)) {}

Recordings::~Recordings() = default;

std::shared_ptr<record::Recorder> Recordings::recorder(Stream stream) const {
  const std::scoped_lock lock(mutex_);
  const bool wanted =
      stream == Stream::Any || (stream == Stream::Raw ? running_.raw : running_.fused);
  return wanted ? running_.recorder : nullptr;
}

void Recordings::settle() {
  if (!running_.recorder) return;
  RecordingReport report = running_.recorder->report();
  if (is_running(report)) return;
  frames_ended_ += report.frames;
  dropped_ended_ += report.dropped;
  if (report.state == RecordingState::Failed) ++failed_;
  last_ = report.name;
  ended_[last_] = std::move(report);
  running_ = {};
}

std::optional<RecordingReport> Recordings::newest() const {
  const std::scoped_lock lock(mutex_);
  if (running_.recorder) return running_.recorder->report();
  const auto last = ended_.find(last_);
  return last == ended_.end() ? std::nullopt : std::optional(last->second);
}

record::RecorderOptions Recordings::options_for(const RecordingRequest& request) const {
  record::RecorderOptions options;
  options.name = request.name.empty() ? record::utc_name(options_.clock->now()) : request.name;
  options.folder = fs::path(options_.config.folder) / options.name;
  options.head = options_.head;
  options.limits = options_.config.limits;
  options.stop_after = request.duration;
  options.clock = options_.clock;
  return options;
}

Result<RecordingReport> Recordings::start(const RecordingRequest& request) {
  if (options_.config.folder.empty()) {
    return fail(ErrorCode::Forbidden, std::string(kWhere),
                "recording is off here: set recording.folder in the configuration");
  }
  const std::scoped_lock one_at_a_time(starting_);
  {
    const std::scoped_lock lock(mutex_);
    settle();
    if (running_.recorder) {
      return fail(ErrorCode::Conflict, std::string(kWhere),
                  "a recording is running: DELETE /recordings/" + running_.recorder->report().name +
                      " ends it");
    }
  }
  record::RecorderOptions options = options_for(request);
  const std::string name = options.name;
  auto recorder = record::Recorder::start(std::move(options));
  if (!recorder) {
    log::error("recording not started", {{"reason", to_string(recorder.error())}});
    return refused(recorder.error(), name);
  }
  const RecordingReport report = (*recorder)->report();
  log::info("recording", {{"name", report.name}});
  const std::scoped_lock lock(mutex_);
  running_ = {std::move(*recorder), request.raw, request.fused};
  return report;
}

Result<RecordingReport> Recordings::stop(std::string_view name) {
  const auto known = find(name);
  if (!known || !is_running(*known)) return known;
  const auto recorder = this->recorder(Stream::Any);
  if (!recorder) return find(name);
  recorder->ask_to_stop();
  log::info("recording stops", {{"name", name}});
  return recorder->report();
}

Result<std::optional<double>> Recordings::mark(std::string_view name, const std::string& text) {
  const auto known = find(name);
  if (!known) return pass(known);
  const auto recorder = this->recorder(Stream::Any);
  if (!is_running(*known) || !recorder) return std::nullopt;
  const Timestamp now = options_.clock->now();
  if (!recorder->offer(record::Marked{now, text}))
    return fail(ErrorCode::Unavailable, "recordings/" + std::string(name), "it is ending");
  return std::max(0.0, seconds(now - known->started));
}

std::map<std::string, RecordingReport> Recordings::some(const std::string& after,
                                                        std::size_t most) const {
  const std::scoped_lock lock(mutex_);
  std::map<std::string, RecordingReport> reports;
  for (auto it = ended_.upper_bound(after); it != ended_.end() && reports.size() < most; ++it)
    reports.insert(*it);
  if (!running_.recorder) return reports;
  auto report = running_.recorder->report();
  if (report.name <= after) return reports;
  reports[report.name] = report;
  if (reports.size() > most) reports.erase(std::prev(reports.end()));
  return reports;
}

Result<RecordingReport> Recordings::find(std::string_view name) const {
  {
    const std::scoped_lock lock(mutex_);
    const std::string key(name);
    if (running_.recorder && running_.recorder->report().name == key)
      return running_.recorder->report();
    if (const auto found = ended_.find(key); found != ended_.end()) return found->second;
  }
  return fail(ErrorCode::NotFound, "recordings/" + std::string(name),
              "there is no recording of this name");
}

Result<std::vector<fs::path>> Recordings::files_of(const std::string& name) const {
  const auto report = find(name);
  if (!report) return pass(report);
  if (is_running(*report))
    return fail(ErrorCode::Unavailable, "recordings/" + name,
                "it is still being written: stop it first");
  std::vector<fs::path> files;
  for (const record::RecordedFile& file : report->files)
    files.push_back(fs::path(options_.config.folder) / name / file.name);
  return files;
}

void Recordings::adopt(const RecordingReport& report) {
  const std::scoped_lock lock(mutex_);
  ended_[report.name] = report;
}

Result<http::DocumentPtr> Recordings::list(const http::Request& request) const {
  const auto page = page_of(request);
  if (!page) return pass(page);
  auto reports = some(page->after, page->limit + 1);
  const bool more = reports.size() > page->limit;
  if (more) reports.erase(std::prev(reports.end()));
  resource::Node node{"", {"RecordingList", "ldp:BasicContainer", "ldp:Container"}, {}};
  std::vector<Ref> contains;
  std::vector<resource::Node> members;
  std::string version;
  for (const auto& [name, report] : reports) {
    contains.push_back({name});
    members.push_back(recording_node(report, name));
    version += version_of(report) + "/";
  }
  node.properties.emplace_back("title", std::string("recordings"));
  node.properties.emplace_back("contains", std::move(contains));
  node.properties.emplace_back("recordings", std::move(members));
  http::DocumentOptions options;
  options.version = options_.serving.run + "-" + std::to_string(std::hash<std::string>{}(version));
  options.headers = {{"Accept-Post", "application/json"}};
  if (more) {
    options.headers.emplace_back("Link", "<?after=" + reports.rbegin()->first + "&limit=" +
                                             std::to_string(page->limit) + ">; rel=\"next\"");
  }
  return resource::document_of(std::move(node), std::move(options),
                               options_.serving.place("recordings/"), resource::Kind::Container);
}

http::DocumentPtr Recordings::description(const RecordingReport& report) const {
  http::DocumentOptions options;
  options.version = options_.serving.run + "-" + version_of(report);
  return resource::document_of(recording_node(report, ""), std::move(options),
                               options_.serving.place("recordings/" + report.name));
}

Result<http::DocumentPtr> Recordings::one(const std::string& name) const {
  if (!name.ends_with(kSuffix)) {
    return find(name).map([this](const RecordingReport& report) { return description(report); });
  }
  const auto report = find(name.substr(0, name.size() - kSuffix.size()));
  if (!report) return pass(report);
  if (report->files.size() == 1) return file(report->name, report->files.front().name);
  return fail(ErrorCode::Conflict, "recordings/" + name,
              "this recording has " + std::to_string(report->files.size()) +
                  " files: take them one by one, as \"files\" of /recordings/" + report->name +
                  " lists them");
}

Result<http::DocumentPtr> Recordings::file(const std::string& name, const std::string& file) const {
  const auto report = find(name);
  if (!report) return pass(report);
  const auto& files = report->files;
  const bool known = std::any_of(files.begin(), files.end(),
                                 [&](const record::RecordedFile& f) { return f.name == file; });
  if (!known) {
    return fail(ErrorCode::NotFound, "recordings/" + name + "/" + file,
                "the recording has no file of this name");
  }
  if (report->state == RecordingState::Stopping) {
    return fail(ErrorCode::Unavailable, "recordings/" + name + "/" + file,
                "the recording is being finished; ask again in a second");
  }
  auto body = http::FileBody::open(fs::path(options_.config.folder) / name / file);
  if (!body) return pass(body);
  http::DocumentOptions options;
  options.version = options_.serving.run + "-" + file + "-" + std::to_string((*body)->size());
  options.headers = {{"Content-Disposition", "attachment; filename=\"" + file + "\""}};
  options.file = std::move(*body);
  return resource::other_document("application/octet-stream", {}, std::move(options));
}

Result<http::ActionResult> Recordings::post(const http::Request& request) {
  const auto wanted = parse_recording_request(request.body, options_.has_fused);
  if (!wanted) return pass(wanted);
  const auto report = start(*wanted);
  if (!report) return pass(report);
  return http::ActionResult{http::status::kCreated, description(*report),
                            "/recordings/" + report->name};
}

void Recordings::add_routes(http::Router& router) {
  using http::PathParams;
  using http::Request;
  router.get("/recordings/",
             [this](const Request& request, const PathParams&) { return list(request); });
  router.get("/recordings/{name}",
             [this](const Request&, const PathParams& path) { return one(path.at("name")); });
  router.get("/recordings/{name}/{file}", [this](const Request&, const PathParams& path) {
    return file(path.at("name"), path.at("file"));
  });
  router.shows_people("/recordings/{name}");
  router.shows_people("/recordings/{name}/{file}");
  router.action(http::Method::Post, "/recordings/",
                [this](const Request& request, const PathParams&) { return post(request); });
  router.action(http::Method::Delete, "/recordings/{name}",
                [this](const Request&, const PathParams& path) -> Result<http::ActionResult> {
                  const auto report = stop(path.at("name"));
                  if (!report) return pass(report);
                  return http::ActionResult{
                      is_running(*report) ? http::status::kAccepted : http::status::kOk,
                      description(*report),
                      {}};
                });
}

std::string Recordings::metrics_text() const {
  std::uint64_t frames = 0;
  std::uint64_t dropped = 0;
  std::uint64_t failed = 0;
  bool active = false;
  {
    const std::scoped_lock lock(mutex_);
    frames = frames_ended_;
    dropped = dropped_ended_;
    failed = failed_;
    if (running_.recorder) {
      const RecordingReport report = running_.recorder->report();
      frames += report.frames;
      dropped += report.dropped;
      active = is_running(report);
      failed += report.state == RecordingState::Failed ? 1 : 0;
    }
  }
  const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
  MetricsText text;
  text.gauge({"chorus_recording_active", "1 while something is recorded."}, active ? 1.0 : 0.0);
  text.counter({"chorus_recording_frames_total", "Frames written to recordings."}, number(frames));
  text.counter({"chorus_recording_dropped_total",
                "Frames not recorded because the recorder's queue was full."},
               number(dropped));
  text.counter({"chorus_recording_failures_total", "Recordings that the disk ended."},
               number(failed));
  return text.text();
}

}  // namespace chorus::service
