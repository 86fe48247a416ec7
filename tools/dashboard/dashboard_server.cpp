// SPDX-License-Identifier: Apache-2.0
#include "dashboard_server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <mutex>
#include <set>
#include <thread>

#include "dashboard_page.hpp"
#include "visitors.hpp"

namespace fdcg::tools {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using Code = boost::system::error_code;
using Text = std::shared_ptr<const std::string>;
using namespace std::chrono_literals;

constexpr std::size_t kMostClients = 16, kMostEvents = 64, kMostCommands = 256;
constexpr std::size_t kLongestCommand = 200, kLongestRequest = 8192;  // bytes
constexpr auto kPatience = 5s;                                        // for a request

std::string_view field_of(const http::request<http::string_body>& request, http::field name) {
  const auto found = request.find(name);
  return found == request.end() ? std::string_view() : std::string_view(found->value().data(), found->value().size());
}

}  // namespace

// All of it belongs to the server's thread, but for the commands.
struct DashboardServer::Impl {
  class Client;

  asio::io_context io{1};
  Tcp::acceptor acceptor{io};
  std::thread thread;
  std::set<std::shared_ptr<Client>> clients;
  std::mutex commands_mutex;
  std::vector<std::string> commands;

  void accept();
  void add_command(std::string command);
};

class DashboardServer::Impl::Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Tcp::socket socket, Impl& server) : stream_(std::move(socket)), server_(server) {}

  void start() {
    parser_.header_limit(kLongestRequest);
    parser_.body_limit(0);
    beast::get_lowest_layer(stream_).expires_after(kPatience);
    http::async_read(stream_.next_layer(), buffer_, parser_,
                     [self = shared_from_this()](Code code, std::size_t) { code ? self->end() : self->take_request(); });
  }
  void close() { beast::get_lowest_layer(stream_).close(); }
  void send_snapshot(const Text& text) {
    snapshot_ = text;
    write();
  }
  void send_event(const Text& text) {
    if (events_.size() < kMostEvents) events_.push_back(text);
    write();
  }

 private:
  void end() { server_.clients.erase(shared_from_this()); }

  void take_request() {
    const auto& request = parser_.get();
    if (!may_come(field_of(request, http::field::host), field_of(request, http::field::origin)))
      return answer(http::status::forbidden, "text/plain", "not from another site\n");
    if (!websocket::is_upgrade(request)) return answer(http::status::ok, "text/html; charset=utf-8", kDashboardPage);
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    stream_.read_message_max(kLongestCommand);
    stream_.async_accept(request, [self = shared_from_this()](Code code) {
      if (code) return self->end();
      self->is_open_ = true;
      self->read();
      self->write();
    });
  }

  void answer(http::status status, const char* type, const char* body) {
    response_ = {status, parser_.get().version()};
    response_.set(http::field::content_type, type);
    response_.set(http::field::x_frame_options, "DENY");
    response_.body() = body;
    response_.keep_alive(false);
    response_.prepare_payload();
    http::async_write(stream_.next_layer(), response_, [self = shared_from_this()](Code, std::size_t) {
      Code ignored;
      beast::get_lowest_layer(self->stream_).socket().shutdown(Tcp::socket::shutdown_send, ignored);
      self->end();
    });
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](Code code, std::size_t) {
      if (code) return self->end();
      self->server_.add_command(beast::buffers_to_string(self->buffer_.data()));
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
    stream_.async_write(asio::buffer(*being_sent_), [self = shared_from_this()](Code code, std::size_t) {
      self->being_sent_ = nullptr;
      if (!code) self->write();  // else the read ends too
    });
  }

  websocket::stream<beast::tcp_stream> stream_;
  Impl& server_;
  beast::flat_buffer buffer_{kLongestRequest};
  http::request_parser<http::string_body> parser_;
  http::response<http::string_body> response_;
  bool is_open_ = false;
  Text snapshot_, being_sent_;
  std::deque<Text> events_;
};

void DashboardServer::Impl::accept() {
  acceptor.async_accept([this](Code code, Tcp::socket socket) {
    if (code == asio::error::operation_aborted) return;
    if (!code && clients.size() < kMostClients) {
      const auto client = std::make_shared<Client>(std::move(socket), *this);
      clients.insert(client);
      client->start();
    }
    accept();
  });
}

void DashboardServer::Impl::add_command(std::string command) {
  const std::lock_guard<std::mutex> lock(commands_mutex);
  if (commands.size() < kMostCommands) commands.push_back(std::move(command));
}

DashboardServer::DashboardServer() : impl_(std::make_unique<Impl>()) {}

DashboardServer::~DashboardServer() {
  if (!impl_->thread.joinable()) return;
  asio::post(impl_->io, [this] {
    Code ignored;
    impl_->acceptor.close(ignored);
    for (const auto& client : impl_->clients)
      client->close();
  });
  impl_->thread.join();
}

std::string DashboardServer::start(std::uint16_t port) {
  const Tcp::endpoint here(asio::ip::address_v4::loopback(), port);
  Code code;
  impl_->acceptor.open(here.protocol(), code);
  if (!code) impl_->acceptor.set_option(asio::socket_base::reuse_address(true), code);
  if (!code) impl_->acceptor.bind(here, code);
  if (!code) impl_->acceptor.listen(asio::socket_base::max_listen_connections, code);
  if (code) return "127.0.0.1:" + std::to_string(port) + ": cannot listen there: " + code.message();
  impl_->accept();
  impl_->thread = std::thread([this] { impl_->io.run(); });
  return {};
}

std::uint16_t DashboardServer::port() const {
  Code ignored;
  return impl_->acceptor.local_endpoint(ignored).port();
}

void DashboardServer::publish_snapshot(std::string text) {
  asio::post(impl_->io, [this, shared = std::make_shared<const std::string>(std::move(text))] {
    for (const auto& client : impl_->clients)
      client->send_snapshot(shared);
  });
}

void DashboardServer::publish_event(const std::string& text) {
  asio::post(impl_->io, [this, shared = std::make_shared<const std::string>(text)] {
    for (const auto& client : impl_->clients)
      client->send_event(shared);
  });
}

void DashboardServer::take_commands(std::vector<std::string>* commands) {
  const std::lock_guard<std::mutex> lock(impl_->commands_mutex);
  commands->insert(commands->end(), impl_->commands.begin(), impl_->commands.end());
  impl_->commands.clear();
}

}  // namespace fdcg::tools
