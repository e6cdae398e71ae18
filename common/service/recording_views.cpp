#include "common/service/recording_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/file.h"
#include "common/base/fnv.h"
#include "common/base/json.h"
#include "common/base/log.h"
#include "common/base/parse.h"
#include "common/http/status.h"
#include "common/record/free_space.h"
#include "common/resource/link_lines.h"
#include "common/time/clock.h"

namespace chorus::service {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr JsonLimits kBody{4096, 3};
constexpr JsonLimits kMarks{1u << 20, 5};
constexpr std::size_t kLongestMark = 200;
constexpr std::size_t kMostMarks = 1000;

Result<json> object_of(std::string_view body, const char* example) {
  auto parsed = parse_json(body, kBody);
  if (parsed && parsed->is_object()) return parsed;
  return fail(ErrorCode::InvalidArgument, "body",
              std::string("send a JSON object, such as ") + example);
}

double number_in(const json& object, const char* key) {
  const auto member = object.find(key);
  return member != object.end() && member->is_number() ? member->get<double>() : std::nan("");
}

std::string string_in(const json& object, const char* key) {
  const auto member = object.find(key);
  return member != object.end() && member->is_string() ? member->get<std::string>() : "";
}

/// The number that the query states; `fallback` if it states none; NaN for anything else.
double number_asked(const http::Request& request, const char* key, double fallback) {
  const auto found = request.query.find(key);
  if (found == request.query.end()) return fallback;
  return parse_number<double>(found->second).value_or(std::nan(""));
}

/// A mark as it was stored; none if it is not one.
std::optional<Mark> mark_of(const json& stored) {
  constexpr double kMostId = std::numeric_limits<int>::max();
  if (!stored.is_object()) return std::nullopt;
  const double id = number_in(stored, "id");
  const double seconds = number_in(stored, "seconds");
  if (!(id >= 1.0) || !(id <= kMostId) || id != std::floor(id)) return std::nullopt;
  if (!(seconds >= 0.0) || !std::isfinite(seconds)) return std::nullopt;
  return Mark{static_cast<int>(id), seconds, string_in(stored, "text")};
}

std::string marks_json(const std::vector<Mark>& marks) {
  json all = json::array();
  for (const Mark& mark : marks)
    all.push_back({{"id", mark.id}, {"seconds", mark.seconds}, {"text", mark.text}});
  return all.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace

Result<std::vector<Mark>> stored_marks(const fs::path& file) {
  if (!is_there(file)) return std::vector<Mark>{};
  const auto damaged = [](const std::string& reason) {
    return fail(
        ErrorCode::Conflict, "marks.json",
        "nothing is marked while this file cannot be read: " + reason + "; mend or delete it");
  };
  const auto text = read_file(file, kMarks.bytes);
  if (!text) return damaged(to_string(text.error()));
  const auto stored = parse_json(*text, kMarks);
  if (!stored) return damaged(to_string(stored.error()));
  if (!stored->is_array()) return damaged("it is no list");
  std::vector<Mark> marks;
  for (const json& each : *stored) {
    auto mark = mark_of(each);
    if (!mark)
      return damaged("mark " + std::to_string(marks.size() + 1) +
                     R"( is not such as {"id": 1, "seconds": 12.4, "text": "..."})");
    marks.push_back(std::move(*mark));
  }
  return marks;
}

Result<Mark> parse_mark(std::string_view body) {
  const auto object = object_of(body, R"({"seconds": 12.4, "text": "takes the drill"})");
  if (!object) return pass(object);
  const Mark mark{0, number_in(*object, "seconds"), string_in(*object, "text")};
  const bool present = !object->contains("seconds");
  if (!present && (!(mark.seconds >= 0.0) || !std::isfinite(mark.seconds)))
    return fail(ErrorCode::InvalidArgument, "seconds", "is a number of 0 or more");
  const bool plain = std::ranges::none_of(
      mark.text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
  if (mark.text.empty() || mark.text.size() > kLongestMark || !plain)
    return fail(ErrorCode::InvalidArgument, "text",
                "is 1 to " + std::to_string(kLongestMark) + " bytes on one line");
  return mark;
}

Result<CutRequest> parse_cut(std::string_view body) {
  const auto object = object_of(body, R"({"from": 3, "to": 8.5, "name": "walk-2"})");
  if (!object) return pass(object);
  CutRequest cut{number_in(*object, "from"), number_in(*object, "to"), string_in(*object, "name")};
  if (!(cut.from >= 0.0) || !(cut.to > cut.from) || !std::isfinite(cut.to))
    return fail(ErrorCode::InvalidArgument, "from",
                "`from` and `to` are seconds, the second later");
  if (!record::is_recording_name(cut.name))
    return fail(ErrorCode::InvalidArgument, "name",
                "a name is 1 to 64 characters of A-Z a-z 0-9 _ -");
  return cut;
}

http::DocumentPtr RecordingViews::document(std::string text) const {
  http::DocumentOptions options;
  options.version = options_.run + "-" + std::to_string(fnv1a(text));
  return resource::other_document("application/json", std::move(text), std::move(options));
}

/// Opens the recording, unless it is open; call it with the mutex held.
Result<record::RecordingView*> RecordingViews::view_of(const std::string& name) {
  const auto files = options_.files_of(name);
  if (!files) return pass(files);
  if (view_ && open_ == name) return view_.get();
  auto view = record::RecordingView::open(*files);
  if (!view) return pass(view);
  view_ = std::make_unique<record::RecordingView>(std::move(*view));
  open_ = name;
  return view_.get();
}

Result<http::DocumentPtr> RecordingViews::outline(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  const auto view = view_of(name);
  if (!view) return pass(view);
  json out = json::parse((*view)->outline(), nullptr, false);
  out["name"] = name;
  const auto file = marks_file(name);
  out["writable"] = file.has_value();
  if (file) {
    const auto marks = stored_marks(*file);
    if (!marks) out["notes"].push_back(to_string(marks.error()));
    out["marks"] = json::parse(marks_json(marks.value_or(std::vector<Mark>{})));
  }
  if (const auto own = cuts_.find(name); own != cuts_.end()) {
    out["cut"] = {{"name", own->second.name}};
    if (!own->second.trouble.empty()) out["cut"]["problem"] = own->second.trouble;
  }
  return document(out.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

Result<http::DocumentPtr> RecordingViews::stretch(const std::string& name,
                                                  const http::Request& request) {
  const record::Stretch asked{number_asked(request, "from", 0.0),
                              number_asked(request, "to", std::nan("")),
                              number_asked(request, "every", 0.0)};
  const std::scoped_lock lock(mutex_);
  const auto view = view_of(name);
  if (!view) return pass(view);
  auto text = (*view)->stretch(asked);
  if (!text) return pass(text);
  return document(std::move(*text));
}

Result<http::DocumentPtr> RecordingViews::frame(const std::string& name,
                                                const http::Request& request) {
  const std::scoped_lock lock(mutex_);
  const auto view = view_of(name);
  if (!view) return pass(view);
  auto text = (*view)->frame_at(number_asked(request, "at", std::nan("")));
  if (!text) return pass(text);
  return document(std::move(*text));
}

Result<fs::path> RecordingViews::marks_file(const std::string& name) const {
  if (options_.folder.empty())
    return fail(ErrorCode::Conflict, "recordings/" + name, "this recording can only be looked at");
  return options_.folder / name / "marks.json";
}

Result<http::DocumentPtr> RecordingViews::marks(const std::string& name) {
  const auto files = options_.files_of(name);  // Unavailable: it still runs, and can be marked
  if (!files && files.error().code != ErrorCode::Unavailable) return pass(files);
  const auto file = marks_file(name);
  if (!file) return pass(file);
  const std::scoped_lock lock(mutex_);
  const auto all = stored_marks(*file);
  if (!all) return pass(all);
  return document(marks_json(*all));
}

Result<http::ActionResult> RecordingViews::mark(const std::string& name, std::string_view body) {
  auto wish = parse_mark(body);
  if (!wish) return pass(wish);
  const bool present = std::isnan(wish->seconds);
  if (present) {
    const auto now = options_.mark_running(name, wish->text);
    if (!now) return pass(now);
    if (*now) {
      wish->seconds = **now;
      return keep(name, std::move(*wish));
    }
  }
  if (const auto files = options_.files_of(name); !files) {
    return present || files.error().code != ErrorCode::Unavailable
               ? pass(files)
               : fail(ErrorCode::Conflict, "seconds",
                      "while a recording runs, marks are set at the present: leave `seconds` out");
  }
  if (present)
    return fail(ErrorCode::InvalidArgument, "seconds",
                "is missing: the recording has ended, so say where the mark is");
  return keep(name, std::move(*wish));
}

Result<http::ActionResult> RecordingViews::keep(const std::string& name, Mark mark) {
  const auto file = marks_file(name);
  if (!file) return pass(file);
  const std::scoped_lock lock(mutex_);
  auto all = stored_marks(*file);
  if (!all) return pass(all);
  if (all->size() >= kMostMarks)
    return fail(ErrorCode::TooLarge, "marks",
                "at most " + std::to_string(kMostMarks) + " are kept");
  for (const Mark& each : *all) mark.id = std::max(mark.id, each.id);
  if (mark.id == std::numeric_limits<int>::max())
    return fail(ErrorCode::TooLarge, "marks", "no higher `id` is left: remove the highest one");
  ++mark.id;
  all->push_back(std::move(mark));
  std::ranges::stable_sort(*all, {}, &Mark::seconds);
  if (auto kept = replace_file(*file, marks_json(*all)); !kept) return pass(kept);
  return http::ActionResult{http::status::kCreated, document(marks_json(*all)),
                            "/recordings/" + name + "/marks"};
}

Result<http::ActionResult> RecordingViews::unmark(const std::string& name, const std::string& id) {
  if (const auto files = options_.files_of(name); !files) return pass(files);
  const auto file = marks_file(name);
  if (!file) return pass(file);
  const std::scoped_lock lock(mutex_);
  auto all = stored_marks(*file);
  if (!all) return pass(all);
  const auto own = [&](const Mark& each) { return std::to_string(each.id) == id; };
  if (std::erase_if(*all, own) == 0)
    return fail(ErrorCode::NotFound, "marks/" + id, "there is no such mark");
  if (auto kept = replace_file(*file, marks_json(*all)); !kept) return pass(kept);
  return http::ActionResult{http::status::kOk, document(marks_json(*all)), {}};
}

/// Runs on the cutter's thread.
void RecordingViews::run_cut(const CutJob& job, const std::stop_token& stop) {
  const fs::path folder = options_.folder / job.request.name;
  const std::string file = job.request.name + ".mcap";
  const auto frames = record::cut_recording(job.files, job.cut, folder / file, stop);
  record::RecordingReport report;
  report.name = job.request.name;
  report.state = record::RecordingState::Finished;
  report.started = job.cut.from;
  report.stopped = job.cut.to;
  report.files = {{file, job.cut.from, 0}};
  std::string trouble = frames ? "" : to_string(frames.error());
  std::error_code failed;
  if (frames) {
    report.frames = *frames;
    report.files.front().bytes = fs::file_size(folder / file, failed);
    if (auto kept = record::write_index(folder, report); !kept) trouble = to_string(kept.error());
  } else {
    fs::remove(folder, failed);  // Only if it is empty.
  }
  const std::scoped_lock lock(mutex_);
  cutting_ = false;
  if (trouble.empty()) {
    cuts_.erase(job.source);
    options_.made(report);
    return;
  }
  log::error("recording not cut", {{"name", job.source}, {"reason", trouble}});
  cuts_[job.source].trouble = std::move(trouble);
}

Result<record::Cut> RecordingViews::cut_of(const CutRequest& wish,
                                           const record::RecordingView& view) const {
  if (wish.from > view.length())
    return fail(ErrorCode::InvalidArgument, "from",
                fmt::format("the recording is {:.1f} s long", view.length()));
  if (auto room = record::enough_space(options_.folder, options_.min_free_bytes); !room)
    return pass(room);
  return record::Cut{view.first() + from_seconds(wish.from),
                     view.first() + from_seconds(std::min(wish.to, view.length())),
                     options_.min_free_bytes};
}

Result<http::ActionResult> RecordingViews::cut(const std::string& name, std::string_view body) {
  const auto wish = parse_cut(body);
  if (!wish) return pass(wish);
  const auto files = options_.files_of(name);
  if (!files) return pass(files);
  if (const auto writable = marks_file(name); !writable) return pass(writable);
  const std::scoped_lock lock(mutex_);
  if (cutting_)
    return fail(ErrorCode::Conflict, "recordings/" + name,
                "another recording is being cut; try again in a while");
  const auto view = view_of(name);
  if (!view) return pass(view);
  const auto cut = cut_of(*wish, **view);
  if (!cut) return pass(cut);
  std::error_code failed;
  if (!fs::create_directory(options_.folder / wish->name, failed))
    return fail(failed ? ErrorCode::Io : ErrorCode::Conflict, "recordings/" + wish->name,
                failed ? failed.message()
                       : "there is a recording of this name already: choose another `name`");
  cutting_ = true;
  cuts_[name] = {wish->name, {}};
  cutter_ = std::jthread([this, job = CutJob{name, *wish, *cut, *files}](
                             const std::stop_token& stop) { run_cut(job, stop); });
  return http::ActionResult{http::status::kAccepted, nullptr, "/recordings/" + wish->name};
}

void RecordingViews::add_routes(http::Router& router) {
  using http::Method;
  using http::PathParams;
  using http::Request;
  const std::string one = "/recordings/{name}";
  router.get(one + "/outline",
             [this](const Request&, const PathParams& path) { return outline(path.at("name")); });
  router.get(one + "/stretch", [this](const Request& request, const PathParams& path) {
    return stretch(path.at("name"), request);
  });
  router.get(one + "/frame", [this](const Request& request, const PathParams& path) {
    return frame(path.at("name"), request);
  });
  for (const char* what : {"/outline", "/stretch", "/frame", "/marks"})
    router.shows_people(one + what);
  router.get(one + "/marks",
             [this](const Request&, const PathParams& path) { return marks(path.at("name")); });
  if (options_.folder.empty()) return;
  router.action(Method::Post, one + "/marks",
                [this](const Request& request, const PathParams& path) {
                  return mark(path.at("name"), request.body);
                });
  router.action(Method::Delete, one + "/marks/{id}",
                [this](const Request&, const PathParams& path) {
                  return unmark(path.at("name"), path.at("id"));
                });
  router.action(Method::Post, one + "/cut", [this](const Request& request, const PathParams& path) {
    return cut(path.at("name"), request.body);
  });
}

}  // namespace chorus::service
