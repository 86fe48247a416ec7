// SPDX-License-Identifier: Apache-2.0
// Haply's devices by way of their Inverse Service: JSON over a WebSocket on this computer, a state for each message that is
// sent (documentation of the Inverse SDK 3.5: "WebSocket protocol", "Control commands"). Commands hold for one tick of the
// service; without them the device gives no force, so a host that dies leaves none.
//
// settings: {"host": "127.0.0.1", "port": 10001, "device": "049D", "rate_hz": 1000, "force_key": "vector"}; all may be left
// out. device: of several, by its id. force_key: "values" for services before 3.5.
#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "polled_device.hpp"

namespace fdcg::plugin {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using nlohmann::json;
using WebSocket = beast::websocket::stream<beast::tcp_stream>;

constexpr auto kPatience = std::chrono::seconds(1);  // for an answer: then the service is gone
constexpr std::size_t kLongestMessage = 1'000'000;   // bytes

bool read_vector(const json& from, double (&to)[3]) {
  int axis = 0;
  for (const char* const key : {"x", "y", "z"}) {
    const auto found = from.find(key);
    if (found == from.end() || !found->is_number()) return false;
    to[axis++] = found->get<double>();
  }
  return true;
}

class HaplyInverse final : public PolledDevice {
 public:
  explicit HaplyInverse(const Settings& settings)
      : PolledDevice(settings.number("rate_hz", 1000, 1, 8000)),
        host_(settings.text("host", "127.0.0.1")),
        port_(std::to_string(static_cast<int>(settings.number("port", 10001, 1, 65535)))),
        wanted_(settings.text("device", "")),
        force_key_(settings.text("force_key", "vector")) {}

 private:
  std::string connect() override try {
    socket_ = std::make_unique<WebSocket>(io_);
    beast::tcp_stream& stream = beast::get_lowest_layer(*socket_);
    const auto addresses = asio::ip::tcp::resolver(io_).resolve(host_, port_);
    within_patience([&](auto done) { stream.async_connect(addresses, done); });
    stream.socket().set_option(asio::ip::tcp::no_delay(true));
    socket_->read_message_max(kLongestMessage);
    within_patience([&](auto done) { socket_->async_handshake(host_ + ":" + port_, "/", done); });
    descriptor_ = stream.socket().native_handle();
    const std::string problem = choose(json::parse(receive()));
    is_first_ = true;
    if (!problem.empty()) disconnect();
    return problem;
  } catch (const std::exception& error) {
    disconnect();
    return "ws://" + host_ + ":" + port_ + ": " + error.what() + "; does the Inverse Service run?";
  }

  void disconnect() override {
    descriptor_ = -1;
    socket_ = nullptr;
  }

  bool exchange(const fdcg_transport_force& force, fdcg_transport_sample* sample) override try {
    const json vector = {{"x", force.force_n[0]}, {"y", force.force_n[1]}, {"z", force.force_n[2]}};
    json message;
    if (is_first_) message["session"]["configure"]["profile"]["name"] = "fdcg";
    is_first_ = false;
    message["inverse3"] = json::array({{{"device_id", id_}, {"commands", {{"set_cursor_force", {{force_key_, vector}}}}}}});
    const std::string text = message.dump();
    within_patience([&](auto done) { socket_->async_write(asio::buffer(text), done); });
    const json state = json::parse(receive());
    const json* const device = find(state);
    if (device == nullptr) return false;
    if (!read_vector(device->at("state").at("cursor_position"), sample->position_m)) return false;
    sample->buttons = buttons_of(state);
    return true;
  } catch (const std::exception&) {
    return false;
  }

  // The service drops the force of a session that ends.
  void stop_at_once() noexcept override {
    if (const int descriptor = descriptor_; descriptor >= 0) shutdown(descriptor, SHUT_RDWR);
  }

  // An operation and its end. Throws where it fails or takes too long.
  template <class Start>
  void within_patience(const Start& start) {
    beast::error_code outcome;
    beast::get_lowest_layer(*socket_).expires_after(kPatience);
    start([&outcome](beast::error_code code, const auto&...) { outcome = code; });
    io_.restart();
    io_.run();
    if (outcome) throw boost::system::system_error(outcome);
  }

  std::string receive() {
    beast::flat_buffer buffer;
    within_patience([&](auto done) { socket_->async_read(buffer, done); });
    return beast::buffers_to_string(buffer.data());
  }

  std::string choose(const json& inventory) {
    std::string ids;
    id_.clear();
    for (const json& device : inventory.value("inverse3", json::array())) {
      const std::string id = device.value("device_id", "");
      if (id_.empty() && (wanted_.empty() || id == wanted_)) id_ = id;
      ids += (ids.empty() ? "" : ", ") + id;
    }
    if (!id_.empty()) return {};
    return ids.empty() ? "the Inverse Service has no Inverse3; switch it on"
                       : "the Inverse Service has no device \"" + wanted_ + "\"; it has " + ids;
  }

  const json* find(const json& state) const {
    const auto devices = state.find("inverse3");
    if (devices == state.end() || !devices->is_array()) return nullptr;
    for (const json& device : *devices)
      if (device.value("device_id", "") == id_) return &device;
    return nullptr;
  }

  // Of the first grip: a, b, c.
  static std::uint32_t buttons_of(const json& state) {
    for (const char* const kind : {"wireless_verse_grip", "verse_grip"}) {
      const auto grips = state.find(kind);
      if (grips == state.end() || !grips->is_array() || grips->empty()) continue;
      const json& grip = (*grips)[0].at("state");
      if (grip.contains("button")) return grip["button"].get<bool>() ? 1 : 0;
      std::uint32_t buttons = 0;
      const json pressed = grip.value("buttons", json::object());
      for (int i = 0; i < 3; ++i)
        if (pressed.value(std::string(1, static_cast<char>('a' + i)), false)) buttons |= 1U << i;
      return buttons;
    }
    return 0;
  }

  const std::string host_, port_, wanted_, force_key_;
  asio::io_context io_;
  std::unique_ptr<WebSocket> socket_;
  std::atomic<int> descriptor_{-1};
  std::string id_;
  bool is_first_ = true;
};

}  // namespace
}  // namespace fdcg::plugin

extern "C" int fdcg_transport_create(std::uint32_t abi, const char* settings, fdcg_transport* transport,
                                     fdcg_host_message* why) {
  return fdcg::plugin::create_device<fdcg::plugin::HaplyInverse>(
      abi, settings, {"host", "port", "device", "rate_hz", "force_key"}, transport, why);
}
