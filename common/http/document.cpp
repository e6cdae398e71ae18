#include "common/http/document.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <mutex>

#include "common/http/media_range.h"
#include "common/http/page_lines.h"
#include "common/http/text.h"

namespace chorus::http {
namespace {

struct TypeRow {
  std::string_view media_type;
  std::string_view tag;         ///< The last part of the ETag.
  std::string_view parameters;  ///< Sent after the media type.
};

constexpr std::array kTypes{
    TypeRow{"text/turtle", "ttl", ""},
    TypeRow{"application/ld+json", "jsonld", ""},
    TypeRow{"application/json", "json", ""},
    TypeRow{"application/n-triples", "nt", ""},
    TypeRow{"text/html", "html", "; charset=utf-8"},
    TypeRow{"text/plain", "txt", "; charset=utf-8"},
    TypeRow{"text/css", "css", "; charset=utf-8"},
    TypeRow{"text/javascript", "js", "; charset=utf-8"},
};

constexpr std::string_view kJson = "application/json";
constexpr std::array<std::string_view, 2> kEventTypes{kJson, "text/turtle"};

/// Writes JSON, where a line break is only white space, as one data line; a line break would end
/// the field.
void append_as_one_line(std::string& out, std::string_view text) {
  out += "data: ";
  for (const char c : text) out += c == '\n' || c == '\r' ? ' ' : c;
  out += '\n';
}

/// Writes one data line for each line of the text; the reader joins them with line feeds.
void append_line_by_line(std::string& out, std::string_view text) {
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find_first_of("\r\n", begin);
    out.append("data: ").append(text.substr(begin, end - begin)).append("\n");
    if (end == std::string_view::npos) return;
    begin = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
  }
}

const TypeRow* row_of(std::string_view media_type) {
  const auto row = std::find_if(kTypes.begin(), kTypes.end(), [&](const TypeRow& candidate) {
    return candidate.media_type == without_parameters(media_type);
  });
  return row == kTypes.end() ? nullptr : &*row;
}

std::string content_type(const std::string& media_type) {
  const TypeRow* row = row_of(media_type);
  if (row == nullptr || media_type.find(';') != std::string::npos) return media_type;
  return media_type + std::string(row->parameters);
}

/// The ETag: strong and quoted; characters that an entity tag cannot contain become '_' (RFC 9110
/// 8.8.3).
std::string entity_tag(const DocumentOptions& options, const Variant& variant, std::size_t index) {
  const TypeRow* row = row_of(variant.media_type);
  std::string text = options.version + "-";
  if (!variant.profile.empty()) text += variant.profile + "-";
  text += row != nullptr ? std::string(row->tag) : "v" + std::to_string(index);
  for (char& c : text) {
    if (c <= ' ' || c == '"' || c == '\x7f') c = '_';
  }
  return '"' + text + '"';
}

/// Appends a header line.  A line break in the value would begin another header field, so it
/// becomes a space.
void add_line(std::string& out, std::string_view name, std::string_view value) {
  out.append(name).append(": ");
  for (const char c : value) out += c == '\r' || c == '\n' ? ' ' : c;
  out.append("\r\n");
}

/// Runs an action once, on whichever thread comes first; an action that throws may be tried again.
/// std::call_once is not used, because the thread sanitizer hangs when its action throws.
class Once {
 public:
  template <class Action>
  void run(const Action& action) {
    if (done_.load(std::memory_order_acquire)) return;
    const std::scoped_lock lock(mutex_);
    if (done_.load(std::memory_order_relaxed)) return;
    action();
    done_.store(true, std::memory_order_release);
  }

 private:
  std::mutex mutex_;
  std::atomic<bool> done_ = false;
};

}  // namespace

struct Document::Impl {
  std::vector<Variant> variants;
  DocumentOptions options;
  std::vector<std::string_view> offers;  ///< Media types without parameters, by variant.
  std::vector<Rendered> rendered;  ///< By variant; then the gzip form of each, in the same order.
  std::unique_ptr<Once[]> once;
  struct Event {
    Once once;
    std::shared_ptr<const std::string> text;
    Once coded_once;
    std::shared_ptr<const std::string> coded;  ///< The event as a gzip_piece.
  };
  std::unique_ptr<Event[]> events;  ///< By variant.

  /// The lines that a 200 and a 304 share.
  [[nodiscard]] std::string shared_lines(const Rendered& out, std::string_view own) const {
    std::string lines;
    add_line(lines, "ETag", out.etag);
    add_line(lines, "Cache-Control", options.cache_control);
    if (!options.content_location.empty())
      add_line(lines, "Content-Location", options.content_location);
    lines.append(own);
    // No page goes out without a policy, whoever made it.
    if (options.page || is_page(out.media_type))
      lines.append(page_lines(options.page.value_or(Page::Plain), options.import_map));
    for (const auto& [name, value] : options.headers) add_line(lines, name, value);
    return lines;
  }

  void render(std::size_t index) {
    const std::string body = variants[index].render();
    Rendered& out = rendered[index];
    out.media_type = offers[index];
    out.etag = entity_tag(options, variants[index], index);
    const std::string shared = shared_lines(out, variants[index].lines);
    const auto size = options.file ? options.file->size() : body.size();
    write_wire(out, content_type(variants[index].media_type), {shared, body, size});
  }

  struct Content {
    const std::string& lines;  ///< The header lines that a 304 has as well.
    const std::string& body;
    std::uint64_t size = 0;
  };
  static void write_wire(Rendered& out, const std::string& type, const Content& content) {
    std::string wire;
    constexpr std::size_t kTypeAndLength = 128;
    wire.reserve(content.lines.size() + content.body.size() + kTypeAndLength);
    add_line(wire, "Content-Type", type);
    add_line(wire, "Content-Length", std::to_string(content.size));
    wire.append(content.lines).append("\r\n");
    out.head_size = wire.size();
    out.wire = std::make_shared<const std::string>(wire.append(content.body));
    out.not_modified = content.lines + "\r\n";
  }

  /// Renders the gzip form.  It is another representation, so its ETag differs: "42-json" and
  /// "42-json-gz".
  void compress(std::size_t index) {
    const Rendered& plain = rendered[index];
    Rendered& out = rendered[variants.size() + index];
    out.media_type = plain.media_type;
    out.etag = plain.etag.substr(0, plain.etag.size() - 1) + "-gz\"";
    std::string shared = shared_lines(out, variants[index].lines);
    add_line(shared, "Content-Encoding", "gzip");
    const std::string body = gzipped(plain.body());
    write_wire(out, content_type(variants[index].media_type), {shared, body, body.size()});
  }

  Result<const Rendered*> rendered_at(std::size_t index) {
    try {
      once[index].run([&] { render(index); });
      return &rendered[index];
    } catch (const std::exception& failure) {
      return fail(ErrorCode::Internal, std::string(offers[index]),
                  std::string("the representation cannot be written: ") + failure.what());
    }
  }

  /// rendered_at(), in its gzip form if that is worth it.
  Result<const Rendered*> coded_at(std::size_t index, Coding coding) {
    auto plain = rendered_at(index);
    if (!plain || coding == Coding::Identity || options.file) return plain;
    if (!worth_compressing((*plain)->media_type, (*plain)->body().size())) return plain;
    const std::size_t coded = variants.size() + index;
    once[coded].run([&] { compress(index); });
    return &rendered[coded];
  }

  /// The variant that events of this type and profile show; none: there is no such variant.
  [[nodiscard]] std::optional<std::size_t> index_of(std::string_view media_type,
                                                    std::string_view profile) const {
    if (std::ranges::find(kEventTypes, media_type) == kEventTypes.end()) return std::nullopt;
    for (std::size_t i = 0; i < variants.size(); ++i) {
      if (variants[i].profile == profile && offers[i] == media_type) return i;
    }
    return std::nullopt;
  }

  void make_event(std::size_t index) {
    const auto chosen = rendered_at(index);
    if (!chosen) return;
    std::string text = "id: " + options.version + "\n";
    const std::string_view body = (*chosen)->body();
    offers[index] == kJson ? append_as_one_line(text, body) : append_line_by_line(text, body);
    events[index].text = std::make_shared<const std::string>(text + "\n");
  }
};

Document::Document(std::vector<Variant> variants, DocumentOptions options)
    : impl_(std::make_unique<Impl>()) {
  impl_->variants = std::move(variants);
  impl_->options = std::move(options);
  const std::size_t count = impl_->variants.size();
  impl_->rendered.resize(2 * count);
  impl_->once = std::make_unique<Once[]>(2 * count);
  impl_->events = std::make_unique<Impl::Event[]>(count);
  for (const Variant& variant : impl_->variants)
    impl_->offers.push_back(without_parameters(variant.media_type));
}

Document::~Document() = default;

Result<const Rendered*> Document::choose(std::string_view accept, std::string_view profile,
                                         Coding coding) const {
  // Most requests have no preference and no profile.
  const auto& variants = impl_->variants;
  if (accept.empty() && profile.empty() && !variants.empty() && variants[0].profile.empty())
    return impl_->coded_at(0, coding);

  std::vector<std::string_view> offers;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    if (variants[i].profile != profile) continue;
    offers.push_back(impl_->offers[i]);
    indices.push_back(i);
  }
  if (offers.empty())
    return fail(ErrorCode::NotFound, "profile",
                "this resource has no profile \"" + std::string(profile) + "\"");
  if (const auto best = negotiate(offers, accept)) return impl_->coded_at(indices[*best], coding);
  std::string list;
  for (const auto offer : offers) list.append(list.empty() ? "" : ", ").append(offer);
  return fail(ErrorCode::NotAcceptable, "Accept",
              "none of the accepted media types is available; ask for one of: " + list);
}

std::shared_ptr<const std::string> Document::event(std::string_view media_type,
                                                   std::string_view profile, Coding coding) const {
  const auto index = impl_->index_of(media_type, profile);
  if (!index) return nullptr;
  Impl::Event& event = impl_->events[*index];
  event.once.run([&] { impl_->make_event(*index); });
  if (coding == Coding::Identity || event.text == nullptr) return event.text;
  event.coded_once.run(
      [&] { event.coded = std::make_shared<const std::string>(gzip_piece(*event.text)); });
  return event.coded;
}

std::vector<std::string_view> Document::media_types(std::string_view profile) const {
  std::vector<std::string_view> types;
  for (std::size_t i = 0; i < impl_->variants.size(); ++i) {
    if (impl_->variants[i].profile == profile) types.push_back(impl_->offers[i]);
  }
  return types;
}

const DocumentOptions& Document::options() const noexcept { return impl_->options; }

DocumentPtr make_document(std::string media_type, std::string body, DocumentOptions options) {
  std::vector<Variant> variants;
  variants.push_back({std::move(media_type), [text = std::move(body)] { return text; }});
  return std::make_shared<const Document>(std::move(variants), std::move(options));
}

}  // namespace chorus::http
