// SPDX-License-Identifier: Apache-2.0
#include "dashboard_server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <mutex>
#include <set>
#include <thread>

#include "dashboard_client.hpp"

namespace fdcg::tools {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Tcp = asio::ip::tcp;
using Code = boost::system::error_code;

constexpr std::size_t kMostClients = 16, kMostCommands = 256;

}  // namespace

// All of it belongs to the server's thread, but for the commands.
struct DashboardServer::Impl {
  using Client = DashboardClient<beast::tcp_stream, Impl>;

  asio::io_context io{1};
  Tcp::acceptor acceptor{io};
  std::thread thread;
  std::set<std::shared_ptr<Client>> clients;
  std::mutex commands_mutex;
  std::vector<std::string> commands;

  void accept();
  void add_command(std::string command);
  void end(const std::shared_ptr<Client>& client) { clients.erase(client); }
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
