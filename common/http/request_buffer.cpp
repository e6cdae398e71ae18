#include "common/http/request_buffer.h"

#include <algorithm>
#include <cstring>

namespace chorus::http {

RequestBuffer::RequestBuffer(std::size_t capacity)
    : bytes_(std::make_unique_for_overwrite<char[]>(capacity)), capacity_(capacity) {}

HeadEnd RequestBuffer::find_head() {
  const HeadEnd head = find_head_end(unread(), checked_);
  if (head.progress == HeadProgress::Incomplete) checked_ = unread().size();
  return head;
}

void RequestBuffer::take_body(std::size_t head_size, std::size_t most, std::string& body) {
  char* const from = bytes_.get() + begin_ + head_size;
  char* const end = bytes_.get() + end_;
  const std::size_t part = std::min(most, static_cast<std::size_t>(end - from));
  body.append(from, part);
  std::memmove(from, from + part, static_cast<std::size_t>(end - from) - part);
  end_ -= part;
}

void RequestBuffer::drop(std::size_t size) {
  begin_ += size;
  checked_ = 0;
}

void RequestBuffer::compact() {
  if (begin_ == 0) return;
  std::memmove(bytes_.get(), bytes_.get() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
}

}  // namespace chorus::http
