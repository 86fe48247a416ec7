// SPDX-License-Identifier: Apache-2.0
// Any bytes as what a client sends to the dashboard, over a stream in memory: a request and what follows it, or, of every
// second input, what follows a handshake that is right. The first byte says which, and whether all is sent at once; the second
// how much of it is read at once. Whoever becomes a WebSocket has named this computer, a command is no longer than is allowed,
// and nothing of a client that has gone is left.
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/beast/_experimental/test/stream.hpp>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dashboard/dashboard_client.hpp"

namespace {

using Stream = boost::beast::test::stream;
using namespace fdcg::tools;

void require(bool is_kept, const char* promise) {
  if (is_kept) return;
  std::fprintf(stderr, "broken: %s\n", promise);
  std::abort();
}

struct Server {
  using Client = DashboardClient<Stream, Server>;

  std::shared_ptr<Client> client;
  std::vector<std::string> commands;

  void add_command(std::string command) { commands.push_back(std::move(command)); }
  void end(const std::shared_ptr<Client>&) { client = nullptr; }
};

constexpr std::string_view kHandshake =
    "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";

bool names_this_computer(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* const name : {"localhost", "127.0.0.1", "[::1]"})
    if (text.find(name) != std::string::npos) return true;
  return false;
}

// Until nothing is left to do but to wait.
void settle(boost::asio::io_context& io) {
  io.restart();
  while (io.poll() > 0) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size < 2) return 0;
  static boost::asio::io_context io(1);
  const bool is_greeted = data[0] % 2 == 0;
  std::string text(reinterpret_cast<const char*>(data) + 2, size - 2);
  std::string head(kHandshake);
  if (!is_greeted) {
    head = text.substr(0, text.find("\r\n\r\n"));
    text.erase(0, head.size());
    head += text.substr(0, 4);
    text.erase(0, 4);
  }
  if (data[0] / 2 % 2 == 1) head += std::exchange(text, "");
  Server server;
  Stream peer(io), stream(io);
  stream.read_size(std::max<std::size_t>(1 + data[1], size / 16));  // a byte at a time where that is no long input
  stream.connect(peer);
  server.client = std::make_shared<Server::Client>(std::move(stream), server);
  const std::weak_ptr<Server::Client> seen = server.client;
  server.client->start();
  boost::asio::write(peer, boost::asio::buffer(head));
  settle(io);
  const std::string answer(peer.str());
  const bool is_open = answer.rfind("HTTP/1.1 101", 0) == 0;
  require(!is_greeted || is_open || head.size() > kHandshake.size(), "who greets in the right way comes in");
  require(!is_open || names_this_computer(head), "who comes in has named this computer");
  require(is_open || server.commands.empty(), "nobody commands before the handshake");
  if (server.client) server.client->send_event(std::make_shared<const std::string>("{}"));
  if (server.client) boost::asio::write(peer, boost::asio::buffer(text));
  settle(io);
  if (server.client) server.client->send_snapshot(std::make_shared<const std::string>("{}"));
  settle(io);
  require(is_open || server.commands.empty(), "who is not in commands nothing");
  for (const std::string& command : server.commands)
    require(command.size() <= kLongestCommand, "a command is short");
  peer.close();
  settle(io);
  require(server.client == nullptr && seen.expired(), "nothing is left of who has gone");
  return 0;
}
