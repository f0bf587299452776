// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/line_connection.h"

#include <poll.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>

namespace mgtd::daemon::serve {

namespace asio = boost::asio;
using boost::system::error_code;

LineConnection::LineConnection(Socket socket, std::size_t line_limit)
    : socket_(std::move(socket)), framer_(line_limit) {
  error_code ignored;
  socket_.non_blocking(true, ignored);
}

void LineConnection::start(Handlers handlers) {
  handlers_ = std::move(handlers);
  read();
}

void LineConnection::read() {
  socket_.async_read_some(asio::buffer(in_), [self = shared_from_this()](error_code ec, std::size_t n) {
    if (!self->open_) return;
    if (ec == asio::error::eof) return self->sending_ended();
    if (ec) return self->close(ec.message());
    self->received({self->in_.data(), n});
    if (self->open_) self->read();
  });
}

void LineConnection::received(std::string_view bytes) {
  framer_.feed(
      bytes,
      [&](std::string_view line) {
        if (open_) handlers_.on_line(line);
      },
      [&] {
        if (open_) handlers_.on_overlong();
      });
}

void LineConnection::sending_ended() {
  pollfd state{socket_.native_handle(), 0, 0};  // POLLHUP and POLLERR are always reported
  const bool gone = ::poll(&state, 1, 0) != 0;
  if (gone || !handlers_.keep_after_end || !handlers_.keep_after_end()) {
    return close("the client closed the connection");
  }
  socket_.async_wait(Socket::wait_error, [self = shared_from_this()](error_code ec) {
    if (self->open_) self->close(ec ? ec.message() : "the client is gone");
  });
}

void LineConnection::send(std::string_view bytes) {
  out_ += bytes;
  write();
}

void LineConnection::flush() {
  if (!open_ || waiting_) return;
  handlers_.refill(out_);
  const bool more = out_.size() >= kBatch;
  write();
  if (more && open_ && !waiting_) {
    asio::post(socket_.get_executor(), [self = shared_from_this()] { self->flush(); });
  }
}

void LineConnection::write() {
  if (!open_ || waiting_) return;
  while (backlog() > 0) {
    error_code ec;
    const std::size_t n = socket_.write_some(asio::buffer(out_) + written_, ec);
    written_ += n;
    bytes_out_ += n;
    if (ec == asio::error::would_block) return await_writable();
    if (ec) return close(ec.message());
  }
  out_.clear();
  written_ = 0;
}

void LineConnection::await_writable() {
  waiting_ = true;
  socket_.async_wait(Socket::wait_write, [self = shared_from_this()](error_code ec) {
    self->waiting_ = false;
    if (!self->open_) return;
    if (ec) return self->close(ec.message());
    self->flush();
  });
}

void LineConnection::close(std::string_view reason) {
  if (!open_) return;
  open_ = false;
  error_code ignored;
  socket_.shutdown(Socket::shutdown_both, ignored);
  socket_.close(ignored);
  if (handlers_.on_close) handlers_.on_close(reason);
  // One of the handlers may be what called this: they go when it has returned.
  asio::post(socket_.get_executor(), [handlers = std::move(handlers_)] {});
}

}  // namespace mgtd::daemon::serve
