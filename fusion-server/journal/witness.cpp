#include "fusion-server/journal/witness.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace chorus::journal {
namespace {

struct Kind {
  std::string_view name;
  Severity severity = Severity::Calm;
  std::string_view advice = {};
};

constexpr Kind kSensorLive{"sensor-live"};
constexpr Kind kSensorLost{"sensor-lost", Severity::Warning,
                           "Look after its host and its program, chorus-sensor; it is asked again "
                           "and again, and joins in by itself."};
constexpr Kind kSensorBack{"sensor-back"};
constexpr Kind kSensorRefused{"sensor-refused", Severity::Error,
                              "Correct its address or its token under \"sensors\" in the "
                              "configuration."};
constexpr Kind kSensorMoved{"sensor-moved", Severity::Warning, "Register the sensors anew."};
constexpr Kind kContested{"sensor-contested", Severity::Warning,
                          "A mirror, a coat or a moved sensor shows somebody who is not there; "
                          "if somebody is, something hides them from the others."};
constexpr Kind kSensorInPlace{"sensor-in-place"};
constexpr Kind kVerdict{"verdict-changed"};
constexpr Kind kVerdictWorse{"verdict-changed", Severity::Warning,
                             "Walk through the room again: chorus register."};
constexpr Kind kAdopted{"registration-adopted"};
constexpr Kind kNotAdopted{"registration-not-adopted", Severity::Warning,
                           "Walk again, where two sensors see you at the same time."};
constexpr Kind kProposed{"registration-proposed", Severity::Warning,
                         "Accept the new places, or keep the old ones."};
constexpr Kind kReplaced{"registration-replaced"};
constexpr Kind kNotStored{"registration-not-stored", Severity::Error,
                          "Make room on the disk of state_dir, or correct its rights."};
constexpr Kind kClientCame{"output-client-came"};
constexpr Kind kClientLost{"output-client-lost", Severity::Warning,
                           "If nobody ended that program, look after it and its network."};
constexpr Kind kOutputFailed{
    "output-failed", Severity::Error,
    "Correct its section under \"outputs\", then reload the configuration."};
constexpr Kind kOutputOpen{"output-open"};
constexpr Kind kDiskLow{"disk-nearly-full", Severity::Warning,
                        "Make room on the disk, or end the recording."};
constexpr Kind kDiskRoom{"disk-has-room"};
constexpr Kind kRecording{"recording-started"};
constexpr Kind kRecordingEnded{"recording-stopped"};
constexpr Kind kRecordingFailed{"recording-failed", Severity::Error,
                                "Correct what it says, then start another recording."};
constexpr Kind kCame{"person-came"};
constexpr Kind kLeft{"person-left"};
constexpr Kind kBack{"person-back"};
constexpr Kind kCorrected{"person-corrected"};

constexpr std::array kKinds{
    kSensorLive,    kSensorLost, kSensorBack,     kSensorRefused,   kSensorMoved, kContested,
    kSensorInPlace, kVerdict,    kAdopted,        kNotAdopted,      kProposed,    kReplaced,
    kNotStored,     kClientCame, kClientLost,     kOutputFailed,    kOutputOpen,  kDiskLow,
    kDiskRoom,      kRecording,  kRecordingEnded, kRecordingFailed, kCame,        kLeft,
    kBack,          kCorrected};

/// Collects the events of one comparison.
class Teller {
 public:
  explicit Teller(Timestamp time) : time_(time) {}

  void tell(const Kind& kind, std::string about, std::string message) {
    events_.push_back({0, time_, std::string(kind.name), std::move(about), kind.severity,
                       std::move(message), std::string(kind.advice)});
  }
  void advise(std::string advice) { events_.back().advice = std::move(advice); }
  [[nodiscard]] std::vector<Event> take() { return std::move(events_); }

 private:
  Timestamp time_;
  std::vector<Event> events_;
};

template <class Items, class Key, class Of>
const typename Items::value_type* found(const Items& items, const Key& key, Of of) {
  const auto it = std::ranges::find(items, key, of);
  return it == items.end() ? nullptr : &*it;
}

std::string because(const std::string& reason) {
  return reason.empty() ? "." : ": " + reason + (reason.ends_with('.') ? "" : ".");
}

void tell_state(Teller& out, const SensorStatus& now, std::string_view before) {
  const std::string& id = now.id.str();
  if (now.state == before) return;
  if (now.state == "live") {
    const bool back = before == "lost" || before == "refused";
    out.tell(back ? kSensorBack : kSensorLive, id,
             back ? id + " delivers frames again." : id + " delivers frames.");
  } else if (now.state == "lost") {
    out.tell(kSensorLost, id, id + " delivers nothing" + because(now.last_error));
  } else if (now.state == "refused") {
    out.tell(kSensorRefused, id, id + " is refused" + because(now.last_error));
  }
}

/// An alarm is a sentence with what to do behind its semicolon.
void tell_moved(Teller& out, const SensorStatus& now) {
  const auto split = now.alarm.find("; ");
  out.tell(kSensorMoved, now.id.str(), now.alarm.substr(0, split) + ".");
  if (split != std::string::npos) out.advise(now.alarm.substr(split + 2));
}

void tell_sensors(Teller& out, const Glimpse& now, const Glimpse* last) {
  for (const SensorStatus& sensor : now.sensors) {
    const auto* was = last ? found(last->sensors, sensor.id, &SensorStatus::id) : nullptr;
    if (was || sensor.state != "live") tell_state(out, sensor, was ? was->state : "connecting");
    const bool alarm_was = was && !was->alarm.empty();
    if (!sensor.alarm.empty() && !alarm_was) tell_moved(out, sensor);
    if (!sensor.contested.empty() && !(was && !was->contested.empty()))
      out.tell(kContested, sensor.id.str(), sensor.contested + ".");
    if (sensor.alarm.empty() && alarm_was)
      out.tell(kSensorInPlace, sensor.id.str(), sensor.id.str() + " stands where it should.");
  }
}

std::string_view name_of(Verdict verdict) {
  constexpr std::array<std::string_view, 4> kNames{"None", "Provisional", "Good", "Refused"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::string joined(const std::vector<std::string>& reasons) {
  return fmt::format("{}", fmt::join(reasons, "; "));
}

void tell_session(Teller& out, const Glimpse& now, const Glimpse& last) {
  if (now.sessions.empty()) return;
  const SessionStatus& session = now.sessions.front();
  const auto* was = found(last.sessions, session.id, &SessionStatus::id);
  const bool ended =
      session.state == SessionState::Done && (was == nullptr || was->state != SessionState::Done);
  if (ended && !session.adopted && !now.proposal)
    out.tell(kNotAdopted, {}, "The walk gave no new places" + because(joined(session.reasons)));
  if (now.proposal && !last.proposal)
    out.tell(kProposed, {}, "The walk gave new places, which wait for a decision.");
}

void tell_registration(Teller& out, const Glimpse& now, const Glimpse& last) {
  tell_session(out, now, last);
  const auto placed = now.registration.sensors.size();
  if (now.registration.version != last.registration.version && placed > 0) {
    const bool solved = now.registration.solved != last.registration.solved;
    out.tell(solved ? kAdopted : kReplaced, {},
             solved ? fmt::format("New places are in use, of {} sensor{}.", placed,
                                  placed == 1 ? "" : "s")
                    : std::string("The world has another origin."));
  }
  const Verdict before = last.registration.verdict;
  const Verdict after = now.registration.verdict;
  if (before == after) return;
  const bool worse = before == Verdict::Good || after == Verdict::Refused;
  out.tell(worse ? kVerdictWorse : kVerdict, {},
           fmt::format("The verdict on the places is {}, it was {}{}", name_of(after),
                       name_of(before), because(joined(now.registration.reasons))));
}

void tell_storage(Teller& out, const Glimpse& now, const Glimpse* last) {
  if (now.storage_trouble.empty() || (last && !last->storage_trouble.empty())) return;
  out.tell(kNotStored, {}, "The places are not stored" + because(now.storage_trouble));
}

void tell_clients(Teller& out, const OutputStatus& now, std::uint64_t before) {
  const std::uint64_t clients = now.counters.clients;
  if (clients == before) return;
  const bool more = clients > before;
  out.tell(more ? kClientCame : kClientLost, now.name,
           fmt::format("{} has {} client{}, it had {}.", now.name, clients, clients == 1 ? "" : "s",
                       before));
}

void tell_outputs(Teller& out, const Glimpse& now, const Glimpse* last) {
  for (const OutputStatus& output : now.outputs) {
    const auto* was = last ? found(last->outputs, output.name, &OutputStatus::name) : nullptr;
    if (!output.error.empty() && (!was || was->error.empty()))
      out.tell(kOutputFailed, output.name, output.name + " is not open" + because(output.error));
    if (output.error.empty() && was && !was->error.empty())
      out.tell(kOutputOpen, output.name, output.name + " is open.");
    if (was) tell_clients(out, output, was->counters.clients);
  }
}

void tell_recording(Teller& out, const Glimpse& now, const Glimpse* last) {
  if (!now.recording) return;
  const RecordingGlimpse& one = *now.recording;
  const bool same = last && last->recording && last->recording->name == one.name;
  const bool ran = same && last->recording->running;
  if (!same) out.tell(kRecording, one.name, "The recording " + one.name + " has begun.");
  if (one.running || (same && !ran)) return;
  if (one.trouble.empty()) {
    out.tell(kRecordingEnded, one.name, "The recording " + one.name + " has ended.");
  } else {
    out.tell(kRecordingFailed, one.name,
             "The recording " + one.name + " ended by itself" + because(one.trouble));
  }
}

std::string called(const KnownPerson& person) {
  const std::string id = std::to_string(person.id.value);
  return person.name.empty() ? "Person " + id : person.name + " (person " + id + ")";
}

std::string corrected(const KnownPerson& person) {
  const Correction& last = *person.correction;
  return fmt::format("{} was shown as person {} for {:.1f} s.", called(person),
                     last.published.value, seconds(last.until - last.since));
}

void tell_people(Teller& out, const Glimpse& now, const Glimpse& last) {
  for (const KnownPerson& person : now.people) {
    const auto* was = found(last.people, person.id, &KnownPerson::id);
    const bool here = person.presence != Presence::Left;
    const bool was_here = was && was->presence != Presence::Left;
    const std::string id = std::to_string(person.id.value);
    if (person.correction && (!was || was->correction != person.correction))
      out.tell(kCorrected, id, corrected(person));
    if (here && !was) out.tell(kCame, id, called(person) + " came.");
    if (here && was && !was_here) out.tell(kBack, id, called(person) + " is back.");
    if (!here && was_here) out.tell(kLeft, id, called(person) + " left.");
  }
}

/// Nearly full: less than twice of what a recording leaves free.  It is over only well above that.
bool tell_disk(Teller& out, const Glimpse& now, bool told) {
  constexpr double kLow = 2.0;
  constexpr double kEnough = 2.5;
  constexpr double kMegabyte = 1e6;
  if (!now.disk_free) return told;
  if (!told && *now.disk_free < kLow * now.disk_least) {
    out.tell(
        kDiskLow, {},
        fmt::format("The disk for recordings has {:.0f} MB left; a recording ends at {:.0f} MB.",
                    *now.disk_free / kMegabyte, now.disk_least / kMegabyte));
    return true;
  }
  if (!told || *now.disk_free < kEnough * now.disk_least) return told;
  out.tell(kDiskRoom, {}, "The disk for recordings has room again.");
  return false;
}

}  // namespace

std::vector<Event> Witness::compare(Glimpse now) {
  Teller out(now.time);
  const Glimpse* last = last_ ? &*last_ : nullptr;
  tell_sensors(out, now, last);
  tell_storage(out, now, last);
  tell_outputs(out, now, last);
  tell_recording(out, now, last);
  if (last) {
    tell_registration(out, now, *last);
    tell_people(out, now, *last);
  }
  disk_told_ = tell_disk(out, now, disk_told_);
  last_ = std::move(now);
  return out.take();
}

const std::vector<std::string_view>& kinds_of_events() {
  static const auto names = [] {
    std::vector<std::string_view> all;
    for (const Kind& kind : kKinds) all.push_back(kind.name);
    return all;
  }();
  return names;
}

}  // namespace chorus::journal
