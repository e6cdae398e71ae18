#include "common/record/recorder.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <random>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "common/base/file.h"
#include "common/base/log.h"
#include "common/record/free_space.h"

namespace chorus::record {
namespace {

/// Whether the event is no frame: it states something about those after it, or names an instant.
bool is_state(const RecordedEvent& event) {
  return std::holds_alternative<PlacesChanged>(event) ||
         std::holds_alternative<CalibrationChanged>(event) || std::holds_alternative<Marked>(event);
}

namespace fs = std::filesystem;

/// Interval at which the open chunk is written to the disk, the index is updated and the free space
/// is checked.
constexpr auto kRest = std::chrono::seconds(1);
/// Events are taken in batches, because waking up for each one would cost more than encoding it.
constexpr auto kBatch = std::chrono::milliseconds(100);
constexpr std::size_t kEarly = 4;  // The thread wakes up early when the queue is 1/4 full.

std::string file_name(const RecorderOptions& options, std::size_t part, Timestamp now) {
  std::string number = std::to_string(part);
  constexpr std::size_t kDigits = 4;
  number.insert(0, kDigits - std::min(kDigits, number.size()), '0');
  return options.name + "-" + number + "-" + utc_name(now) + ".mcap";
}

/// An id such as "20261121T073000Z-1f0c93ab"; it differs even for two runs that begin in the same
/// second.
std::string run_id(Timestamp now) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device random;
  std::string id = utc_name(now) + "-";
  for (int i = 0; i < 8; ++i) id += kDigits[random() % kDigits.size()];
  return id;
}

RecorderOptions identified(RecorderOptions options) {
  if (options.id.empty()) options.id = run_id(options.clock->now());
  return options;
}

}  // namespace

struct Recorder::Impl {
  explicit Impl(RecorderOptions o) : options(identified(std::move(o))) {}
  ~Impl() {
    ask_to_stop();
    if (thread.joinable()) thread.join();
  }

  Result<void> begin();
  Result<void> next_file();
  void run();
  std::vector<RecordedEvent> take();
  Result<void> write(const RecordedEvent& event);
  Result<void> rest();
  void note_size();
  void finish(const Result<void>& how);
  void store_index();
  void tell_end() const;
  void ask_to_stop() {
    {
      const std::scoped_lock lock(mutex);
      stopping = true;
      if (report.state == RecordingState::Recording) report.state = RecordingState::Stopping;
    }
    arrived.notify_all();
  }
  [[nodiscard]] bool rotates() const { return options.file.empty(); }

  const RecorderOptions options;
  // Used only by the recorder's thread:
  std::optional<CellWriter> writer;
  // Written at the beginning of each file.
  std::optional<PlacesChanged> places;
  std::map<SensorId, CalibrationChanged> calibrations;
  Timestamp file_started;
  bool index_lost = false;
  std::chrono::steady_clock::time_point rested = std::chrono::steady_clock::now();

  mutable std::mutex mutex;  ///< Guards the members below.
  std::condition_variable arrived;
  std::condition_variable ended;
  std::deque<RecordedEvent> queue;
  RecordingReport report;
  bool stopping = false;
  bool done = false;
  std::thread thread;
};

Result<void> Recorder::Impl::begin() {
  const Timestamp now = options.clock->now();
  report.name = options.name;
  report.started = now;
  const fs::path place = rotates() ? options.folder : options.file.parent_path();
  std::error_code error;
  if (rotates()) {
    fs::create_directories(options.folder.parent_path(), error);
    const bool fresh = !error && fs::create_directory(options.folder, error);
    if (error) {
      return fail(ErrorCode::Io, options.folder.string(),
                  "the folder cannot be made: " + error.message());
    }
    if (!fresh) return fail(ErrorCode::Conflict, options.folder.string(), "it exists already");
    sync_folder(options.folder.parent_path());
  }
  auto ok = enough_space(place, options.limits.min_free_bytes);
  if (ok) ok = next_file();
  // Removes the folder only if it is empty.
  if (!ok && rotates()) fs::remove(options.folder, error);
  return ok;
}

Result<void> Recorder::Impl::next_file() {
  if (writer) {
    note_size();
    if (auto ok = writer->close(); !ok) return ok;
    note_size();
    writer.reset();
  }
  file_started = options.clock->now();
  const std::size_t part = report.files.size() + 1;
  const fs::path path =
      rotates() ? options.folder / file_name(options, part, file_started) : options.file;
  CellHead head = options.head;
  head.metadata["recording"] = options.id;
  head.metadata["part"] = std::to_string(part);
  auto opened = CellWriter::create(path, head);
  if (!opened) return pass(opened);
  writer.emplace(std::move(*opened));
  sync_folder(path.parent_path());
  {
    const std::scoped_lock lock(mutex);
    report.files.push_back({path.filename().string(), file_started, writer->bytes()});
  }
  store_index();
  if (places) {
    if (auto ok = writer->write(*places); !ok) return ok;
  }
  for (const auto& [source, calibration] : calibrations) {
    if (auto ok = writer->write(calibration); !ok) return ok;
  }
  return {};
}

void Recorder::Impl::note_size() {
  const std::scoped_lock lock(mutex);
  report.files.back().bytes = writer->bytes();
}

void Recorder::Impl::store_index() {
  if (!rotates()) return;
  RecordingReport now;
  {
    const std::scoped_lock lock(mutex);
    now = report;
  }
  // Drops an earlier problem with the index.
  if (now.state != RecordingState::Failed) now.reason.clear();
  const auto stored = write_index(options.folder, now);
  // The recording is worth more than its index, so it continues.
  if (!stored && !index_lost) {
    log::error("the recording's index is not written; without it a restart forgets the recording",
               {{"name", options.name}, {"reason", to_string(stored.error())}});
  }
  index_lost = !stored;
  const std::scoped_lock lock(mutex);
  if (report.state != RecordingState::Failed)
    report.reason = stored ? std::string{} : to_string(stored.error());
}

std::vector<RecordedEvent> Recorder::Impl::take() {
  std::unique_lock lock(mutex);
  arrived.wait_for(lock, kBatch, [this] {
    return queue.size() >= options.limits.max_queue / kEarly || stopping;
  });
  std::vector<RecordedEvent> taken(std::make_move_iterator(queue.begin()),
                                   std::make_move_iterator(queue.end()));
  queue.clear();
  return taken;
}

Result<void> Recorder::Impl::write(const RecordedEvent& event) {
  if (rotates()) {
    const bool full = writer->bytes() >= options.limits.max_file_bytes ||
                      writer->unpacked_bytes() >= options.limits.max_unpacked_bytes;
    const Duration age = options.clock->now() - file_started;
    if (full || age >= options.limits.max_file_duration) {
      if (auto ok = next_file(); !ok) return ok;
    }
  }
  if (const auto* changed = std::get_if<PlacesChanged>(&event)) places = *changed;
  if (const auto* changed = std::get_if<CalibrationChanged>(&event))
    calibrations.insert_or_assign(changed->source, *changed);
  const auto ok = std::visit([this](const auto& one) { return writer->write(one); }, event);
  if (!ok || is_state(event)) return ok;
  const std::scoped_lock lock(mutex);
  ++report.frames;
  return {};
}

/// Once a second: makes the disk store what is only in memory, and checks the free space.
Result<void> Recorder::Impl::rest() {
  const auto now = std::chrono::steady_clock::now();
  if (now - rested < kRest) return {};
  rested = now;
  if (auto ok = writer->flush(); !ok) return ok;
  if (auto ok = writer->sync(); !ok) return ok;
  note_size();
  store_index();
  return enough_space(rotates() ? options.folder : options.file.parent_path(),
                      options.limits.min_free_bytes);
}

void Recorder::Impl::run() {
  Result<void> how;
  try {
    for (bool last = false; how && !last;) {
      {
        const std::scoped_lock lock(mutex);
        last = stopping;  // The events that are queued now are the last to be written.
      }
      for (const RecordedEvent& event : take()) {
        if (how) how = write(event);
      }
      if (how) how = rest();
      const bool over = options.stop_after > Duration{0} &&
                        options.clock->now() - report.started >= options.stop_after;
      if (over) ask_to_stop();
    }
  } catch (const std::exception& thrown) {
    how = fail(ErrorCode::Internal, options.name, thrown.what());
  }
  finish(how);
}

/// Logs that the recording has ended, except for a single file, whose report the caller asks for.
void Recorder::Impl::tell_end() const {
  if (!rotates()) return;
  if (report.state == RecordingState::Failed)
    return log::error("recording failed", {{"name", report.name}, {"reason", report.reason}});
  log::info("recording finished", {{"name", report.name},
                                   {"frames", report.frames},
                                   {"dropped", report.dropped},
                                   {"bytes", report.bytes()}});
}

void Recorder::Impl::finish(const Result<void>& how) {
  const auto closed = writer ? writer->close() : Result<void>{};
  if (writer) note_size();
  writer.reset();
  {
    const std::scoped_lock lock(mutex);
    stopping = true;
    const bool good = how && closed;
    report.state = good ? RecordingState::Finished : RecordingState::Failed;
    if (!good) report.reason = to_string(how ? closed.error() : how.error());
    report.stopped = options.clock->now();
    report.dropped += queue.size();
    queue.clear();
  }
  store_index();
  tell_end();
  {
    const std::scoped_lock lock(mutex);
    done = true;
  }
  ended.notify_all();
}

Recorder::Recorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Recorder::~Recorder() = default;

Result<std::unique_ptr<Recorder>> Recorder::start(RecorderOptions options) {
  auto impl = std::make_unique<Impl>(std::move(options));
  if (auto ok = impl->begin(); !ok) return pass(ok);
  impl->thread = std::thread([raw = impl.get()] { raw->run(); });
  return std::unique_ptr<Recorder>(new Recorder(std::move(impl)));
}

bool Recorder::offer(RecordedEvent event) {
  const std::size_t most = impl_->options.limits.max_queue;
  bool early = false;
  {
    const std::scoped_lock lock(impl_->mutex);
    if (impl_->stopping) return false;
    // A registration, a calibration or a mark is accepted even if the queue is full: it is rare,
    // and what comes after it is meaningless without it.
    if (impl_->queue.size() >= most && !is_state(event)) {
      ++impl_->report.dropped;
      return false;
    }
    impl_->queue.push_back(std::move(event));
    early = impl_->queue.size() == most / kEarly;
  }
  if (early) impl_->arrived.notify_one();
  return true;
}

void Recorder::ask_to_stop() { impl_->ask_to_stop(); }

bool Recorder::wait(std::chrono::milliseconds patience) {
  std::unique_lock lock(impl_->mutex);
  return impl_->ended.wait_for(lock, patience, [this] { return impl_->done; });
}

RecordingReport Recorder::report() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->report;
}

}  // namespace chorus::record
