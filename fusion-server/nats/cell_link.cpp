#include "fusion-server/nats/cell_link.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include "common/base/handover.h"
#include "common/base/log.h"
#include "common/base/rate_report.h"
#include "common/base/version.h"
#include "fusion-server/nats/cell_cards.h"
#include "fusion-server/nats/doorbell.h"
#include "fusion-server/nats/frame_desk.h"
#include "fusion-server/nats/inbox.h"
#include "fusion-server/nats/ledger.h"
#include "fusion-server/nats/people_message.h"
#include "fusion-server/nats/site_look.h"
#include "fusion-server/nats/subjects.h"
#include "fusion-server/site/teller.h"

namespace chorus::nats {
namespace {

/// At most so often are neighbours told: 30 Hz, with room for a tick that comes early.
constexpr Duration kBetweenMessages = std::chrono::milliseconds(30);
constexpr Duration kBetweenCards = std::chrono::seconds(1);
constexpr std::chrono::milliseconds kLinkPatience{100};
/// What neighbours tell is shown at once, but no sooner after another frame of the site: 63 cells
/// tell 1900 times a second.
constexpr std::chrono::milliseconds kBetweenLooks{15};
constexpr std::size_t kSnapshots = 2;
/// Of each cell: its people, a second's worth of its cards and events, and records that bear its
/// name, which all come at once after each new connection; what the ledger has to say.
constexpr std::size_t kPeopleWaiting = 4;
constexpr std::size_t kNewsWaiting = 64;
constexpr std::size_t kClaimsWaiting = 1024;
constexpr std::size_t kResults = 256;
constexpr std::size_t kEventsKept = 50;
/// The store forgets a record so long after its last change (site/claim.h).
constexpr Duration kForgetPeople = std::chrono::hours(1);

/// Of our own cell, from a registration on.
struct Move {
  site::CellPlace place;
  std::uint64_t registration = 0;
};

struct HeardPeople {
  site::CellPeople people;
  Timestamp came;  ///< By our clock.
};

void append_newest(std::vector<site::SiteEvent>& all, const std::vector<site::SiteEvent>& more) {
  all.insert(all.end(), more.begin(), more.end());
  if (all.size() > kEventsKept)
    all.erase(all.begin(), all.end() - static_cast<std::ptrdiff_t>(kEventsKept));
}

void log_event(const site::SiteEvent& event) {
  log::info("site", {{"event", name_of(event.kind)},
                     {"id", event.id.str()},
                     {"other", event.other.str()},
                     {"cell", event.cell.str()}});
}

}  // namespace

struct CellLink::State {
  using OnView = std::function<void(std::shared_ptr<const site::SiteView>)>;

  State(LinkConfig c, std::shared_ptr<const Clock> k, OnView view);
  ~State();

  [[nodiscard]] std::string subject(std::string_view kind) const {
    return subject_of(config.site, config.cell.str(), kind);
  }
  Listening listening();
  void hear_people(const Message& message);
  void hear_card(std::string_view bytes, std::optional<site::CellId> from);
  void hear_event(const Message& message);
  void hear_claim(const Entry& entry);
  void refuse(const std::string& why);

  void run();
  void take_news();
  void take_people();
  [[nodiscard]] std::chrono::nanoseconds patience() const;
  void step(const std::shared_ptr<const Snapshot>& snapshot);
  void look_again();
  void carry_out(const site::Decision& decision);
  std::shared_ptr<site::SiteView> look(SteadyTime now);
  [[nodiscard]] site::SiteConnection connection() const;
  void tell_card();
  void take_place();
  [[nodiscard]] CellCard card() const {
    return {config.cell, boot, config.url, std::string(version()), own_place};
  }

  const LinkConfig config;
  const std::shared_ptr<const Clock> clock;
  const OnView on_view;
  const std::uint64_t boot;

  // Filled by other threads.
  Doorbell bell;  ///< Rings when snapshots, people or the end came.
  Handover<std::shared_ptr<const Snapshot>> snapshots{kSnapshots};
  Inbox<HeardPeople> inbox{kPeopleWaiting};
  Inbox<std::function<void(Timestamp)>> news{kNewsWaiting};  ///< What the core is told next.
  Inbox<site::Claim> claims{kClaimsWaiting};
  Handover<site::ClaimResult> results{kResults};
  std::mutex moving;
  std::optional<Move> move;  ///< Guarded by moving.
  FrameDesk frames;
  std::atomic<std::uint64_t> refused = 0;
  RateReport refusals{"a message of another cell was refused"};

  // Only of the link's thread.
  site::Site site;
  site::Teller teller;
  SiteLook window;
  std::optional<site::CellPlace> own_place;
  CellCards cards;
  std::vector<site::SiteEvent> events;
  std::shared_ptr<const Snapshot> newest;  ///< Of our own cell; null: none yet.
  std::vector<site::Named> ours;           ///< Its people, as they were decided.
  SteadyTime stepped{};                    ///< When `newest` came.
  SteadyTime looked{};
  bool others_told = false;  ///< Of people, since the last look.
  Timestamp told{};
  std::uint64_t registration = 0;  ///< Of the snapshot that is told next.
  SteadyTime card_told{};

  // In this order: the ledger uses the broker, and handlers of the broker use the rest.
  std::unique_ptr<Broker> broker;
  std::unique_ptr<Ledger> ledger;
  std::jthread thread;
};

CellLink::State::State(LinkConfig c, std::shared_ptr<const Clock> k, OnView view)
    : config(std::move(c)),
      clock(std::move(k)),
      on_view(std::move(view)),
      boot(static_cast<std::uint64_t>(to_unix_ns(clock->now()) / 1'000'000)),
      site(config.cell, boot, config.decisions),
      teller(config.cell, boot),
      window(config.cell, config.decisions) {
  broker = std::make_unique<Broker>(config.broker, listening());
  frames.open(*broker, subject(kFrame));
  ledger = std::make_unique<Ledger>(
      *broker, [this](site::ClaimResult result) { results.give(std::move(result)); });
  thread = std::jthread([this] { run(); });
}

CellLink::State::~State() {
  snapshots.close();
  bell.ring();
  if (thread.joinable()) thread.join();
  ledger.reset();
  broker.reset();
}

Listening CellLink::State::listening() {
  const auto all = [this](std::string_view kind) { return subject_of(config.site, "*", kind); };
  Listening out;
  out.subjects.push_back({all(kPeople), [this](const Message& m) { hear_people(m); }});
  for (const std::string_view kind : {kStatus, kRegistration})
    out.subjects.push_back({all(kind), [this](const Message& m) {
                              const auto from = cell_of(m.subject, config.site);
                              if (from) hear_card(m.bytes, from);
                            }});
  out.subjects.push_back({all(kEvents), [this](const Message& m) { hear_event(m); }});
  out.subjects.push_back({subject(kAskFrame), [this](const Message& m) { frames.answer(m); }});
  out.subjects.push_back({subject(kWantFrames), [this](const Message&) { frames.want(); }});
  out.buckets.push_back({kCellsBucket, [this](const Entry& e) {
                           if (auto from = site::CellId::parse(e.key)) hear_card(e.value, *from);
                         }});
  out.buckets.push_back({kPeopleBucket, [this](const Entry& e) { hear_claim(e); }, kForgetPeople});
  return out;
}

void CellLink::State::refuse(const std::string& why) {
  ++refused;
  refusals.hit(why);
}

void CellLink::State::hear_people(const Message& message) {
  const auto from = cell_of(message.subject, config.site);
  auto people = read_people(message.bytes);
  if (!people) return refuse(std::string(message.subject) + ": " + to_string(people.error()));
  // The server lets each cell publish under its own name only.
  if (!from || people->cell != *from)
    return refuse(std::string(message.subject) + ": is by another cell, " + people->cell.str());
  if (people->cell == config.cell && people->boot == boot) return;  // our own words
  inbox.give(*from, {std::move(*people), clock->now()});
  bell.ring();
}

void CellLink::State::hear_card(std::string_view bytes, std::optional<site::CellId> from) {
  auto read = read_card(bytes);
  if (!read) return refuse("card: " + to_string(read.error()));
  if (!from || read->cell != *from) return refuse("card: is by another cell, " + read->cell.str());
  if (read->cell == config.cell) return;
  news.give(*from, [this, heard = std::move(*read)](Timestamp now) {
    const auto newer = cards.hear(heard);
    if (!newer) return refuse(to_string(newer.error()));
    if (!*newer || !heard.place) return;
    if (auto ok = site.take(*heard.place, now); !ok) refuse("card: " + to_string(ok.error()));
  });
}

void CellLink::State::hear_event(const Message& message) {
  const auto from = cell_of(message.subject, config.site);
  const auto joined = read_same_as(message.bytes);
  if (!from || *from == config.cell || !joined) return;
  news.give(*from, [this, joined = *joined, teller_of_it = *from](Timestamp now) {
    site.take(joined, teller_of_it, now);
  });
}

void CellLink::State::hear_claim(const Entry& entry) {
  auto read = read_claim(entry.key, entry.value, entry.revision);
  if (!read) return refuse(to_string(read.error()));
  const site::CellId holder = read->cell;
  claims.give(holder, std::move(*read));
}

void CellLink::State::take_news() {
  const Timestamp now = clock->now();
  for (const auto& each : news.take()) each(now);
  for (const site::Claim& each : claims.take()) site.take(each, now);
  for (const site::ClaimResult& each : results.take(Duration{0})) site.take(each, now);
}

void CellLink::State::take_people() {
  for (const HeardPeople& heard : inbox.take()) {
    if (auto ok = site.take(heard.people, heard.came); !ok)
      refuse(to_string(ok.error()));
    else
      others_told |= !heard.people.people.empty();
  }
}

void CellLink::State::carry_out(const site::Decision& decision) {
  for (const site::ClaimRequest& request : decision.claims) ledger->ask(request);
  for (const site::SiteEvent& event : decision.events) {
    log_event(event);
    broker->publish(subject(kEvents), write_event(event));
  }
  for (const site::SameAs& joined : decision.same_as)
    broker->publish(subject(kEvents), write_same_as(joined));
  append_newest(events, decision.events);
}

site::SiteConnection CellLink::State::connection() const {
  const BrokerStatus status = broker->status();
  return {status.connected,
          status.server,
          status.trouble,
          status.published,
          status.dropped + snapshots.dropped() + inbox.dropped() + news.dropped() +
              claims.dropped() + results.dropped(),
          refused,
          refusals.last()};
}

std::shared_ptr<site::SiteView> CellLink::State::look(SteadyTime now) {
  looked = now;
  others_told = false;
  auto made = std::make_shared<site::SiteView>();
  site::SiteView& view = *made;
  view.site = config.site;
  view.own = config.cell;
  view.at = clock->now();
  view.people = site.everybody(view.at);
  view.ours = ours;
  view.cells = cards.known(site.cells(view.at), card());
  view.events = events;
  view.snapshot = window.show(view.people, {newest, now - stepped, own_place});
  view.connection = connection();
  return made;
}

/// Neighbours have told of their people, and our own cell has nothing new yet.
void CellLink::State::look_again() {
  const SteadyTime now = std::chrono::steady_clock::now();
  // Of a cell that has stopped nothing is shown as if it went on.
  others_told &= newest && now - stepped <= config.decisions.lease;
  if (others_told && now - looked >= kBetweenLooks) on_view(look(now));
}

void CellLink::State::step(const std::shared_ptr<const Snapshot>& snapshot) {
  const Duration since = snapshot->instant - told;
  if (since >= Duration{0} && since < kBetweenMessages) return;
  told = snapshot->instant;
  const Timestamp now = clock->now();
  take_people();
  site::CellPeople people = teller.tell(*snapshot);
  if (auto ok = site.take(people, now); !ok) refuse("our own: " + to_string(ok.error()));
  const site::Decision decision = site.decide(now);
  site::name(people, decision);
  broker->publish(subject(kPeople), write_people(people));
  frames.show(snapshot, now);
  carry_out(decision);
  newest = snapshot;
  ours = decision.people;
  stepped = std::chrono::steady_clock::now();
  const std::shared_ptr<site::SiteView> view = look(stepped);
  view->shown = own_place ? view->snapshot : snapshot;
  on_view(view);
}

void CellLink::State::tell_card() {
  const SteadyTime now = std::chrono::steady_clock::now();
  if (card_told != SteadyTime{} && now - card_told < kBetweenCards) return;
  card_told = now;
  const std::string text = write_card(card());
  broker->publish(subject(kStatus), text);
  ledger->card(config.cell.str(), text);
}

void CellLink::State::take_place() {
  std::optional<Move> taken;
  {
    const std::scoped_lock lock(moving);
    if (move && move->registration <= registration) taken = std::exchange(move, {});
  }
  if (!taken) return;
  site::CellPlace& place = taken->place;
  if (own_place) place.version = std::max(place.version, own_place->version + 1);
  if (auto ok = site.take(place, clock->now()); !ok)
    return refuse("our own place: " + to_string(ok.error()));
  own_place = std::move(place);
  broker->publish(subject(kRegistration), write_card(card()));
  card_told = {};
}

/// How long nothing needs to be done unless something comes.
std::chrono::nanoseconds CellLink::State::patience() const {
  if (!others_told) return kLinkPatience;
  return std::min<std::chrono::nanoseconds>(
      kLinkPatience, kBetweenLooks - (std::chrono::steady_clock::now() - looked));
}

void CellLink::State::run() {
  while (!snapshots.closed()) {
    bell.wait(patience());
    const auto waiting = snapshots.take(Duration{0});
    if (!waiting.empty()) registration = waiting.back()->registration_version;
    take_place();
    take_people();  // What cells told before they moved is of where they stood.
    take_news();
    if (!waiting.empty()) step(waiting.back());
    look_again();
    tell_card();
  }
}

CellLink::CellLink(LinkConfig config, std::shared_ptr<const Clock> clock,
                   std::function<void(std::shared_ptr<const site::SiteView>)> on_view)
    : state_(std::make_unique<State>(std::move(config), std::move(clock), std::move(on_view))) {}

CellLink::~CellLink() = default;

void CellLink::publish(std::shared_ptr<const Snapshot> snapshot) {
  state_->snapshots.give(std::move(snapshot));
  state_->bell.ring();
}

SinkCounters CellLink::counters() const {
  const site::SiteConnection now = state_->connection();
  SinkCounters counters;
  counters.frames = now.published;
  counters.dropped = now.dropped;
  counters.refused = now.refused;
  counters.clients = now.connected ? 1 : 0;
  counters.last_refusal = now.last_refusal;
  counters.last_failure = now.trouble;
  return counters;
}

Result<std::string> CellLink::ask_frame(const std::string& cell, const std::string& at) {
  if (!site::CellId::parse(cell)) return fail(ErrorCode::NotFound, cell, "is no name of a cell");
  auto answer =
      state_->broker->request(subject_of(state_->config.site, cell, kAskFrame), frame_question(at));
  if (!answer)
    return fail(ErrorCode::Unavailable, "cell " + cell,
                "does not answer: " + answer.error().message);
  return frame_answered(cell, std::move(*answer));
}

void CellLink::place(const site::CellPlace& place, std::uint64_t registration) {
  const std::scoped_lock lock(state_->moving);
  state_->move = Move{place, registration};
}

}  // namespace chorus::nats
