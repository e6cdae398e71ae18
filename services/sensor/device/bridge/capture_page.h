// `/capture/`: a page that makes the camera of a phone or laptop this sensor.  Its files are served
// without a token, because a person opens the page before there is a place to enter one.  The files
// are the same for everybody; those outside the page's own folder are listed one by one.
#pragma once

#include <string>

#include "common/base/result.h"
#include "common/http/router.h"

namespace chorus::bridge {

/// Folders of the installed files.
struct CapturePage {
  std::string page;    ///< Its own files.
  std::string runner;  ///< The runner, whose models and engine the page uses.
};

/// NotFound, with what to install, when something is missing.
[[nodiscard]] Result<CapturePage> find_capture_page();

void add_capture_routes(http::Router& router, const CapturePage& installed);

}  // namespace chorus::bridge
