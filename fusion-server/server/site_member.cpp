#include "fusion-server/server/site_member.h"

#include <utility>

#include "fusion-server/core/world.h"

namespace chorus::server {

SiteMember::SiteMember(SiteMemberOptions options, const std::string& places)
    : settings_(options.settings),
      text_(places),
      own_(options.folder),
      link_(settings_.link, std::move(options.clock), std::move(options.on_view)) {
  if (const auto own = own_.typed(place_in_file(settings_, text_))) link_.place(*own);
}

void SiteMember::places(const std::string& text) {
  if (text == text_) return;
  text_ = text;
  const auto place = place_in_file(settings_, text_);
  const std::scoped_lock lock(placing_);
  if (const auto own = own_.typed(place)) link_.place(*own);
}

void SiteMember::follow(const Registration& next) {
  if (next.version == before_.version) return;
  const auto new_from_old = core::moved_world(before_, next);
  before_ = next;
  if (!new_from_old) return;
  const std::scoped_lock lock(placing_);
  if (const auto own = own_.moved(*new_from_old)) link_.place(*own, next.version);
}

}  // namespace chorus::server
