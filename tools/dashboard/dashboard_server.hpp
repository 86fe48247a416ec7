// SPDX-License-Identifier: Apache-2.0
// A WebSocket on the loopback for dashboards: what is published goes to every client, a line that a client sends is a command.
// Only programs of this computer reach it, and of web pages only those of this computer: a page of another origin is refused,
// since any page that a browser shows may try. A client that reads too slowly gets the newest snapshot alone.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace fdcg::tools {

class DashboardServer {
 public:
  DashboardServer();
  ~DashboardServer();  // closes every connection
  DashboardServer(const DashboardServer&) = delete;
  DashboardServer& operator=(const DashboardServer&) = delete;

  // On 127.0.0.1; port 0: any free one. Empty, or why not. A thread of its own serves from then on.
  std::string start(std::uint16_t port);
  [[nodiscard]] std::uint16_t port() const;
  // A JSON text. It takes the place of one that a client has not been sent yet.
  void publish_snapshot(std::string text);
  // A JSON text that every client gets, up to 64 that wait.
  void publish_event(const std::string& text);
  // What clients have sent since the last call.
  void take_commands(std::vector<std::string>* commands);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fdcg::tools
