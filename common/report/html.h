// A report as one self-contained HTML page: no script, no request, printable, light and dark.
#pragma once

#include <string>
#include <string_view>

#include "common/report/report.h"

namespace chorus::report {

/// The page.  Plots are drawn by gnuplot; if that fails, the page says why and shows the data of
/// each plot as a table of its series' ranges.  Blocks for some 20 ms a plot.
[[nodiscard]] std::string html_of(const Report& report);

/// Text in which markup is escaped.
[[nodiscard]] std::string escaped(std::string_view text);

}  // namespace chorus::report
