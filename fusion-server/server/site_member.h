// Our cell as a member of a hall: the link to the other cells, which is told where the cell stands
// when the file of places is read again and when the cell's own origin is moved.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "fusion-server/flow/registration.h"
#include "fusion-server/nats/cell_link.h"
#include "fusion-server/server/own_place.h"
#include "fusion-server/server/site_settings.h"

namespace chorus::server {

struct SiteMemberOptions {
  SiteSettings settings;
  std::string folder;  ///< Of the state; empty: nothing is kept there.
  std::shared_ptr<const Clock> clock;
  /// As CellLink's.
  std::function<void(std::shared_ptr<const site::SiteView>)> on_view;
};

class SiteMember {
 public:
  /// `places`: the text of the file of places.
  SiteMember(SiteMemberOptions options, const std::string& places);

  /// The file of places, as it is now.  Only a change counts.  Only from one thread, which need not
  /// be that of follow().
  void places(const std::string& text);
  /// The registration that is in use; only from one thread.  The neighbours learn of an origin that
  /// was moved with the first people in the new world.
  void follow(const Registration& next);

  [[nodiscard]] nats::CellLink& link() { return link_; }
  [[nodiscard]] const nats::CellLink& link() const { return link_; }

 private:
  const SiteSettings settings_;
  std::string text_;    ///< Of the file of places.
  std::mutex placing_;  ///< Held until the link knows what own_ says: it takes the newest.
  OwnPlace own_;        ///< Guarded by placing_.
  Registration before_;
  nats::CellLink link_;
};

}  // namespace chorus::server
