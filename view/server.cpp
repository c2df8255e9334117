// SPDX-License-Identifier: MIT
#include "view/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <charconv>
#include <chrono>
#include <optional>
#include <vector>

#include "notation/errors.hpp"
#include "view/request_check.hpp"

namespace mixloop {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;
using boost::system::error_code;

using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

constexpr auto kRequestLimit = std::chrono::seconds(10);
constexpr auto kPause = std::chrono::milliseconds(100);
constexpr std::size_t kMostReceived = 64;  // bytes of a message of the page's: a tick

constexpr const char* kPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; connect-src "
    "'self' "
    "ws://127.0.0.1:{0} ws://localhost:{0}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

class Viewer;

struct ServerState {
  explicit ServerState(const ServerOptions& options_)
      : options(options_), acceptor(context), timer(context), refused_for_now(context) {}

  void accept();
  void accept_later();
  void tick(const StopSwitch& stop);
  Response answer(const Request& request) const;

  ServerOptions options;
  asio::io_context context{1};
  tcp::acceptor acceptor;
  asio::steady_timer timer, refused_for_now;
  std::string page;
  std::uint16_t port = 0;
  Source* source = nullptr;
  std::vector<std::shared_ptr<Viewer>> viewers;
};

/// One browser: a WebSocket with at most one message under way. While it is, newer poses pass it by.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(tcp::socket&& socket, ServerState& shared) : socket_(std::move(socket)), shared_(shared) {}

  void start(const Request& request) {
    socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_.read_message_max(kMostReceived);
    socket_.async_accept(request, [self = shared_from_this()](error_code failed) {
      if (failed) return self->leave();
      self->ready_ = true;
      self->receive();
      self->offer();
    });
  }

  /// Sends what is new, unless the last message is still under way.
  void offer() {
    if (!ready_ || sending_) return;
    if (wanted_)
      out_ = shared_.source->at_tick(*std::exchange(wanted_, std::nullopt));
    else if (cursor_.version != shared_.source->version())
      out_ = shared_.source->newest(cursor_);
    else
      return;
    if (out_.empty()) return;
    sending_ = true;
    socket_.text(true);
    socket_.async_write(asio::buffer(out_), [self = shared_from_this()](error_code failed, std::size_t) {
      self->sending_ = false;
      if (failed) return self->leave();
      if (self->wanted_) self->offer();
    });
  }

 private:
  void receive() {
    socket_.async_read(in_, [self = shared_from_this()](error_code failed, std::size_t) {
      if (failed) return self->leave();
      self->hear();
      self->receive();
    });
  }

  // All that a page may say: a tick of a log.
  void hear() {
    const std::string text = beast::buffers_to_string(in_.data());
    in_.consume(in_.size());
    std::int64_t k = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), k);
    if (error != std::errc() || end != text.data() + text.size()) return;
    wanted_ = k;
    offer();
  }

  void leave() {
    ready_ = false;
    std::erase(shared_.viewers, shared_from_this());
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
  }

  websocket::stream<beast::tcp_stream> socket_;
  ServerState& shared_;
  beast::flat_buffer in_;
  std::string out_;
  Cursor cursor_;
  std::optional<std::int64_t> wanted_;
  bool ready_ = false, sending_ = false;
};

namespace {

/// One request, then the connection ends or becomes a Viewer.
class Conversation : public std::enable_shared_from_this<Conversation> {
 public:
  Conversation(tcp::socket&& socket, ServerState& shared) : stream_(std::move(socket)), shared_(shared) {}

  void start() {
    stream_.expires_after(kRequestLimit);
    http::async_read(stream_, buffer_, request_, [self = shared_from_this()](error_code failed, std::size_t) {
      if (!failed) self->answer();
    });
  }

 private:
  void answer() {
    const bool wants_poses = websocket::is_upgrade(request_) && view_of(request_.target()) == "/live";
    response_ = shared_.answer(request_);
    if (wants_poses && response_.result() == http::status::ok) {
      stream_.expires_never();
      auto viewer = std::make_shared<Viewer>(stream_.release_socket(), shared_);
      shared_.viewers.push_back(viewer);
      return viewer->start(request_);
    }
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  beast::tcp_stream stream_;
  ServerState& shared_;
  beast::flat_buffer buffer_{8192};
  Request request_;
  Response response_;
};

}  // namespace

Response ServerState::answer(const Request& request) const {
  const auto reply = [&](http::status status, const char* type, std::string body) {
    Response response(status, request.version());
    response.set(http::field::content_type, type);
    response.set(http::field::cache_control, "no-store");
    response.set("Content-Security-Policy", fmt::format(fmt::runtime(kPolicy), port));
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.keep_alive(false);
    response.body() = std::move(body);
    response.prepare_payload();
    if (request.method() == http::verb::head) response.body().clear();
    return response;
  };
  const auto refuse = [&](http::status status, std::string why) {
    return reply(status, "text/plain; charset=utf-8", std::move(why) + "\n");
  };
  if (!host_is_ours(view_of(request[http::field::host]), port))
    return refuse(http::status::misdirected_request, fmt::format("the Host is not 127.0.0.1:{}", port));
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return refuse(http::status::method_not_allowed, "only GET: a viewer takes no orders");
  const std::string_view target = view_of(request.target());
  if (target == "/live") {
    if (!websocket::is_upgrade(request))
      return refuse(http::status::upgrade_required, "a WebSocket is expected");
    if (!origin_is_ours(view_of(request[http::field::origin]), port))
      return refuse(http::status::forbidden, "the Origin is not this viewer's page");
    if (viewers.size() >= options.most_clients)
      return refuse(http::status::service_unavailable, "too many pages are open");
    return reply(http::status::ok, "text/plain", "");
  }
  if (target == "/") return reply(http::status::ok, "text/html; charset=utf-8", page);
  if (target == "/scene.json") return reply(http::status::ok, "application/json", source->description());
  return refuse(http::status::not_found, "there is /, /scene.json and /live");
}

void ServerState::accept() {
  acceptor.async_accept([this](error_code failed, tcp::socket socket) {
    if (failed == asio::error::operation_aborted) return;
    if (failed) return accept_later();
    std::make_shared<Conversation>(std::move(socket), *this)->start();
    accept();
  });
}

// Whoever knocks while no descriptor is free waits: at once there would be none again, and again.
void ServerState::accept_later() {
  refused_for_now.expires_after(kPause);
  refused_for_now.async_wait([this](error_code stopped) {
    if (!stopped) accept();
  });
}

void ServerState::tick(const StopSwitch& stop) {
  if (stop.turned()) return context.stop();
  timer.expires_after(std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / options.frames_per_second)));
  timer.async_wait([this, &stop](error_code) {
    const auto all = viewers;  // one that leaves changes the list
    for (const auto& viewer : all) viewer->offer();
    tick(stop);
  });
}

Server::Server(const ServerOptions& options, std::string page)
    : shared_(std::make_unique<ServerState>(options)) {
  ServerState& shared = *shared_;
  shared.page = std::move(page);
  const tcp::endpoint place(asio::ip::address_v4::loopback(), options.port);
  error_code failed;
  shared.acceptor.open(place.protocol(), failed);
  shared.acceptor.set_option(asio::socket_base::reuse_address(true), failed);
  shared.acceptor.bind(place, failed);
  if (!failed) shared.acceptor.listen(asio::socket_base::max_listen_connections, failed);
  if (failed)
    throw RunFault("cannot_listen",
                   fmt::format("can't listen on 127.0.0.1:{}: {}; another port: --port 0 takes one "
                               "that is free",
                               options.port, failed.message()));
  shared.port = shared.acceptor.local_endpoint().port();
}

Server::~Server() = default;

std::uint16_t Server::port() const { return shared_->port; }

void Server::run(Source& source, const StopSwitch& stop) {
  shared_->source = &source;
  shared_->accept();
  shared_->tick(stop);
  shared_->context.run();
  shared_->viewers.clear();
}

}  // namespace mixloop
