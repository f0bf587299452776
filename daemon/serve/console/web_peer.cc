// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/web_peer.h"

#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_to_string.hpp>

namespace mgtd::daemon::serve::console {

namespace beast = boost::beast;
using boost::system::error_code;

WebPeer::WebPeer(WebStream stream, std::size_t line_limit) : stream_(std::move(stream)) {
  stream_.read_message_max(line_limit);
  stream_.text(true);
}

void WebPeer::start(Handlers handlers) {
  handlers_ = std::move(handlers);
  read();
}

void WebPeer::read() {
  stream_.async_read(in_, [self = shared_from_this()](error_code ec, std::size_t) {
    if (!self->open_) return;
    if (ec) return self->close(ec.message());
    const std::string line = beast::buffers_to_string(self->in_.data());
    self->in_.consume(self->in_.size());
    self->handlers_.on_line(line);
    if (self->open_) self->read();
  });
}

void WebPeer::send(std::string_view bytes) {
  due_ += bytes;
  write();
}

void WebPeer::flush() {
  if (!open_ || writing_) return;
  handlers_.refill(due_);
  write();
}

void WebPeer::write() {
  if (!open_ || writing_ || due_.empty()) return;
  flying_.swap(due_);
  due_.clear();
  writing_ = true;
  stream_.async_write(boost::asio::buffer(flying_), [self = shared_from_this()](error_code ec, std::size_t) {
    self->writing_ = false;
    self->flying_.clear();
    if (!self->open_) return;
    if (ec) return self->close(ec.message());
    self->flush();
  });
}

void WebPeer::close(std::string_view reason) {
  if (!open_) return;
  open_ = false;
  beast::get_lowest_layer(stream_).close();
  if (handlers_.on_close) handlers_.on_close(reason);
  // One of the handlers may be what called this: they go when it has returned.
  boost::asio::post(stream_.get_executor(), [handlers = std::move(handlers_)] {});
}

}  // namespace mgtd::daemon::serve::console
