// Our cell in its site: tells the neighbours of our people, listens to theirs, and has the pure
// core (fusion-server/site) decide who is who.
//
// A sink: publish() only puts the snapshot into a short queue.  A thread of its own does the rest,
// another one writes to the store.  Nothing here is waited for by the pipeline: without a server,
// with a slow one, or with neighbours that talk nonsense, the cell works as it does without a site.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/time/clock.h"
#include "fusion-server/nats/broker.h"
#include "fusion-server/nats/cell_records.h"
#include "fusion-server/sink.h"
#include "fusion-server/site/site_view.h"

namespace chorus::nats {

/// Where our cell stands is told with CellLink::place().
struct LinkConfig {
  std::string site;   ///< The hall's name; empty: there is no site.
  site::CellId cell;  ///< Our own name in it.
  BrokerConfig broker;
  std::string url;  ///< Where our cell answers, for the neighbours; may be empty.
  site::SiteConfig decisions;

  bool operator==(const LinkConfig&) const = default;
};

class CellLink final : public Sink {
 public:
  /// `on_view` runs on the link's thread after each of our messages, of which there are at most 33
  /// a second, whatever the pipeline's rate, and, without SiteView::shown, when neighbours have
  /// told of people in between, at most every 15 ms; must not wait.
  CellLink(LinkConfig config, std::shared_ptr<const Clock> clock,
           std::function<void(std::shared_ptr<const site::SiteView>)> on_view);
  ~CellLink() override;

  [[nodiscard]] std::string_view name() const override { return "site"; }
  void publish(std::shared_ptr<const Snapshot> snapshot) override;
  [[nodiscard]] SinkCounters counters() const override;

  /// Where our own cell stands from the first snapshot on that was made with this registration or a
  /// later one (zero: at once); the neighbours are told at once.  Newest wins.
  void place(const site::CellPlace& place, std::uint64_t registration = 0);

  /// The frame of a cell, of the instant `at` (nanoseconds since 1970, as text; empty: its newest
  /// one), as its /frame has it in JSON.  Waits for the answer, half a second at most. Unavailable:
  /// the cell does not answer, or with nonsense.  NotFound: it has no frame of that instant.
  [[nodiscard]] Result<std::string> ask_frame(const std::string& cell, const std::string& at);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace chorus::nats
