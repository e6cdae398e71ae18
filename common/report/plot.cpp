#include "common/report/plot.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "common/base/file.h"

namespace chorus::report {
namespace {

constexpr int kWidth = 760;                       // [px]
constexpr std::size_t kLongestSvg = 64UL << 20U;  // [bytes] of one report's plots
// Colours that colour-blind people can distinguish (Okabe and Ito), black last.
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                    "#e69f00", "#56b4e9", "#000000"};

// Single-quoted strings of gnuplot know no escape but the doubled quote, and execute nothing.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20)
      out += ' ';
    else if (c == '\'')
      out += "''";
    else
      out += c;
  }
  return out + "'";
}

std::string number(double value) {
  if (!std::isfinite(value)) return "NaN";
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

// gnuplot refuses a plot without any finite point unless it is told the range.
bool has_a_point(const Plot& plot) {
  for (const Series& series : plot.series)
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i)
      if (std::isfinite(series.x[i]) && std::isfinite(series.y[i])) return true;
  return false;
}

std::string bound(const std::optional<double>& value, const std::string& otherwise) {
  return value && std::isfinite(*value) ? number(*value) : otherwise;
}

std::string axis_lines(const Axis& axis, const std::string& name, bool fits) {
  std::string out = "set " + name + "label " + quoted(axis.label) + "\n";
  if (axis.least || axis.most || !fits)
    out += "set " + name + "range [" + bound(axis.least, fits ? "*" : "0") + ":" +
           bound(axis.most, fits ? "*" : "1") + "]\n";
  if (axis.logarithmic) out += "set logscale " + name + "\n";
  if (axis.categories.empty()) return out;
  out += "set " + name + "tics (";
  for (std::size_t i = 0; i < axis.categories.size(); ++i)
    out += (i == 0 ? "" : ", ") + quoted(axis.categories[i]) + " " + std::to_string(i);
  return out + ")\n";
}

bool has_band(const Series& series) {
  return series.low.size() == series.x.size() && series.high.size() == series.x.size() &&
         !series.x.empty();
}

std::string points_block(const Series& series, const std::string& name) {
  std::string out = name + " << EOD\n";
  const std::size_t count = std::min(series.x.size(), series.y.size());
  for (std::size_t i = 0; i < count; ++i) {
    out += number(series.x[i]) + " " + number(series.y[i]);
    if (has_band(series)) out += " " + number(series.low[i]) + " " + number(series.high[i]);
    out += "\n";
  }
  if (count == 0) out += "NaN NaN NaN NaN\n";  // An empty block is an error to gnuplot.
  return out + "EOD\n";
}

std::string style_of(Mark mark) {
  switch (mark) {
    case Mark::Line:
      return "lines lw 1.5";
    case Mark::Dashes:
      return "lines lw 1.5 dt 2";
    case Mark::Steps:
      return "steps lw 1.5";
    case Mark::Points:
      return "points pt 7 ps 0.4";
    case Mark::Bars:
      return "boxes fs solid 0.6 noborder";
  }
  return "lines";
}

// Bars of several series stand side by side.
struct BarPlaces {
  std::size_t count = 0;
  double width = 0.0;

  explicit BarPlaces(const Plot& plot) {
    for (const Series& series : plot.series) count += series.mark == Mark::Bars ? 1 : 0;
    width = count == 0 ? 0.0 : 0.8 / static_cast<double>(count);
  }
  [[nodiscard]] double shift(std::size_t nth) const {
    return (static_cast<double>(nth) - 0.5 * static_cast<double>(count - 1)) * width;
  }
};

std::string colour_of(std::size_t nth) {
  return " lc rgb '" + std::string(kColours[nth % std::size(kColours)]) + "'";
}

std::string plot_command(const Plot& plot) {
  const BarPlaces bars(plot);
  std::string out = "plot ";
  std::size_t bar = 0;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& series = plot.series[i];
    const std::string block = "$S" + std::to_string(i);
    if (i > 0) out += ", ";
    if (has_band(series))
      out += block + " using 1:3:4 with filledcurves fs transparent solid 0.15 notitle" +
             colour_of(i) + ", ";
    const std::string x =
        series.mark == Mark::Bars ? "($1+" + number(bars.shift(bar++)) + ")" : "1";
    out += block + " using " + x + ":2 with " + style_of(series.mark) + colour_of(i);
    out += series.name.empty() ? " notitle" : " title " + quoted(series.name);
  }
  for (const Level& level : plot.levels) {
    if (out != "plot ") out += ", ";
    out += number(level.y) + " with lines lw 1 dt 3 lc rgb '#666666'";
    out += level.name.empty() ? " notitle" : " title " + quoted(level.name);
  }
  return out == "plot " ? "plot NaN notitle\n" : out + "\n";
}

std::string span_lines(const std::vector<Span>& spans) {
  std::string out;
  for (const Span& span : spans)
    if (std::isfinite(span.from) && std::isfinite(span.to))
      out += "set object rectangle from " + number(span.from) + ", graph 0 to " + number(span.to) +
             ", graph 1 behind fc rgb '#f0c8b0' fs solid 0.6 noborder\n";
  return out;
}

std::string script_of(const Plot& plot) {
  std::string out = "reset\n";
  for (std::size_t i = 0; i < plot.series.size(); ++i)
    out += points_block(plot.series[i], "$S" + std::to_string(i));
  out += "set terminal svg size " + std::to_string(kWidth) + "," + std::to_string(plot.height) +
         " dynamic noenhanced font 'sans-serif,12' background rgb 'white'\n";
  out += "set title " + quoted(plot.title) + "\n";
  out += "set key outside right top\nset grid lc rgb '#dddddd'\nset border 3\n";
  out += "set tics nomirror\nset style fill solid\n";
  const BarPlaces bars(plot);
  if (bars.count > 0) out += "set boxwidth " + number(bars.width) + "\n";
  const bool fits = has_a_point(plot);
  if (plot.same_scale) out += "set size ratio -1\n";
  if (bars.count > 0 && fits) out += "set yrange [*<0:0<*]\n";  // Bars stand on zero.
  out += axis_lines(plot.x, "x", fits) + axis_lines(plot.y, "y", fits) + span_lines(plot.spans);
  return out + plot_command(plot);
}

std::vector<std::string> documents_of(const std::string& output) {
  std::vector<std::string> documents;
  for (std::size_t at = output.find("<svg"); at != std::string::npos;) {
    const std::size_t end = output.find("</svg>", at);
    if (end == std::string::npos) break;
    documents.push_back(output.substr(at, end + 6 - at));
    at = output.find("<svg", end);
  }
  return documents;
}

tl::unexpected<Error> no_gnuplot(const std::string& message) {
  return fail(ErrorCode::Unavailable, "gnuplot",
              message + "; plots need it (apt install gnuplot-nox)");
}

// A file that is gone when its owner is.
class TemporaryScript {
 public:
  explicit TemporaryScript(const std::string& text) {
    const int descriptor = mkstemp(path_.data());
    if (descriptor < 0) return;
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t more = write(descriptor, text.data() + done, text.size() - done);
      if (more < 0 && errno == EINTR) continue;
      if (more <= 0) break;
      done += static_cast<std::size_t>(more);
    }
    close(descriptor);
    whole_ = done == text.size();
    made_ = true;
  }
  ~TemporaryScript() {
    if (made_) unlink(path_.c_str());
  }
  TemporaryScript(const TemporaryScript&) = delete;
  TemporaryScript& operator=(const TemporaryScript&) = delete;

  [[nodiscard]] bool whole() const { return whole_; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_ = "/tmp/chorus-plot-XXXXXX";
  bool made_ = false;
  bool whole_ = false;
};

}  // namespace

std::string gnuplot_script(const std::vector<Plot>& plots) {
  std::string out = "set encoding utf8\n";
  for (const Plot& plot : plots) out += script_of(plot);
  return out;
}

Result<std::vector<std::string>> drawn(const std::vector<Plot>& plots) {
  if (plots.empty()) return std::vector<std::string>{};
  const TemporaryScript script(gnuplot_script(plots));
  if (!script.whole())
    return fail(ErrorCode::Io, script.path(), "cannot be written; is the disk full?");
  // The path is ours and has no special characters.
  FILE* pipe = popen(("gnuplot -d " + script.path() + " 2>/dev/null").c_str(), "re");
  if (pipe == nullptr) return no_gnuplot("cannot be started");
  std::string output;
  char chunk[65536];
  for (std::size_t got = 0;
       output.size() < kLongestSvg && (got = fread(chunk, 1, sizeof chunk, pipe)) > 0;)
    output.append(chunk, got);
  const int status = pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) return no_gnuplot("is not installed");
  std::vector<std::string> documents = documents_of(output);
  if (documents.size() != plots.size())
    return no_gnuplot("drew " + std::to_string(documents.size()) + " of " +
                      std::to_string(plots.size()) + " plots");
  return documents;
}

}  // namespace chorus::report
