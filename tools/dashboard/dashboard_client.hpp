// SPDX-License-Identifier: Apache-2.0
// One who has come to the dashboard: an HTTP request, which gets the page or becomes a WebSocket, then commands one way,
// snapshots and events the other. All of it on one thread.
//
// Stream: boost::beast::tcp_stream, or one in memory, which has no limits of time. Server: who is told of commands,
// add_command(std::string), and of the end, end(std::shared_ptr<DashboardClient>).
#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <memory>
#include <string>

#include "dashboard_page.hpp"
#include "visitors.hpp"

namespace fdcg::tools {

inline constexpr std::size_t kMostEvents = 64;
inline constexpr std::size_t kLongestCommand = 200, kLongestRequest = 8192;  // bytes
inline constexpr std::chrono::seconds kPatience{5};                          // for a request

template <class Stream, class Server>
class DashboardClient : public std::enable_shared_from_this<DashboardClient<Stream, Server>> {
  using Code = boost::system::error_code;
  using Request = boost::beast::http::request_parser<boost::beast::http::string_body>;

 public:
  using Text = std::shared_ptr<const std::string>;

  // Stream: made of it.
  template <class Socket>
  DashboardClient(Socket socket, Server& server) : stream_(std::move(socket)), server_(server) {}

  void start() {
    parser_.header_limit(kLongestRequest);
    parser_.body_limit(0);
    if constexpr (kHasTime) lowest().expires_after(kPatience);
    boost::beast::http::async_read(
        stream_.next_layer(), buffer_, parser_,
        [self = this->shared_from_this()](Code code, std::size_t) { code ? self->end() : self->take_request(); });
  }
  void close() { lowest().close(); }
  void send_snapshot(const Text& text) {
    snapshot_ = text;
    write();
  }
  void send_event(const Text& text) {
    if (events_.size() < kMostEvents) events_.push_back(text);
    write();
  }

 private:
  static constexpr bool kHasTime = requires(Stream & stream) { stream.expires_never(); };

  auto& lowest() { return boost::beast::get_lowest_layer(stream_); }
  void end() { server_.end(this->shared_from_this()); }
  std::string_view field(boost::beast::http::field name) {
    const auto found = parser_.get().find(name);
    return found == parser_.get().end() ? std::string_view() : std::string_view(found->value().data(), found->value().size());
  }

  void take_request() {
    namespace http = boost::beast::http;
    namespace websocket = boost::beast::websocket;
    const auto& request = parser_.get();
    if (!may_come(field(http::field::host), field(http::field::origin)))
      return answer(http::status::forbidden, "text/plain", "not from another site\n");
    if (!websocket::is_upgrade(request)) return answer(http::status::ok, "text/html; charset=utf-8", kDashboardPage);
    // what comes before the answer would be taken for the beginning of the first command
    if (buffer_.size() > 0) return answer(http::status::bad_request, "text/plain", "commands come after the handshake\n");
    if constexpr (kHasTime) lowest().expires_never();
    stream_.set_option(websocket::stream_base::timeout::suggested(boost::beast::role_type::server));
    stream_.read_message_max(kLongestCommand);
    stream_.async_accept(request, [self = this->shared_from_this()](Code code) {
      if (code) return self->end();
      self->is_open_ = true;
      self->read();
      self->write();
    });
  }

  void answer(boost::beast::http::status status, const char* type, const char* body) {
    namespace http = boost::beast::http;
    response_ = {status, parser_.get().version()};
    response_.set(http::field::content_type, type);
    response_.set(http::field::x_frame_options, "DENY");
    response_.body() = body;
    response_.keep_alive(false);
    response_.prepare_payload();
    http::async_write(stream_.next_layer(), response_, [self = this->shared_from_this()](Code, std::size_t) {
      Code ignored;
      if constexpr (kHasTime) self->lowest().socket().shutdown(boost::asio::socket_base::shutdown_send, ignored);
      self->end();
    });
  }

  void read() {
    stream_.async_read(buffer_, [self = this->shared_from_this()](Code code, std::size_t) {
      if (code) return self->end();
      self->server_.add_command(boost::beast::buffers_to_string(self->buffer_.data()));
      self->buffer_.consume(self->buffer_.size());
      self->read();
    });
  }

  void write() {
    if (!is_open_ || being_sent_ || (events_.empty() && !snapshot_)) return;
    if (events_.empty()) {
      being_sent_ = std::move(snapshot_);
      snapshot_ = nullptr;
    } else {
      being_sent_ = events_.front();
      events_.pop_front();
    }
    stream_.async_write(boost::asio::buffer(*being_sent_), [self = this->shared_from_this()](Code code, std::size_t) {
      self->being_sent_ = nullptr;
      if (!code) self->write();  // else the read ends too
    });
  }

  boost::beast::websocket::stream<Stream> stream_;
  Server& server_;
  boost::beast::flat_buffer buffer_{kLongestRequest};
  Request parser_;
  boost::beast::http::response<boost::beast::http::string_body> response_;
  bool is_open_ = false;
  Text snapshot_, being_sent_;
  std::deque<Text> events_;
};

}  // namespace fdcg::tools
