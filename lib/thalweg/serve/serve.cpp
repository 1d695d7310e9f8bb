// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/serve/serve.hpp>

#include <algorithm>
#include <array>
#include <deque>
#include <limits>
#include <list>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <sys/random.h>
#include <utility> // Boost.Asio 1.74 needs it
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::serve {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using http::status;

using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

constexpr std::size_t most_head_bytes = 8192;     ///< of a request's head
constexpr std::size_t most_unread_bytes = 262144; ///< read and discarded of what a request sends beyond its head
constexpr std::size_t most_strangers = 256;       ///< connections that have not shown the token
constexpr std::chrono::seconds closing_time{1};   ///< in which connections close in order

std::string_view view_of(auto const& text) {
    return {text.data(), text.size()};
}

bool is_letter_or_digit(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// Compares in a time that does not depend on where two texts of one length differ.
bool is_same_secret(std::string_view given, std::string_view secret) {
    unsigned difference = given.size() == secret.size() ? 0U : 1U;
    for (std::size_t i = 0; i < given.size(); ++i) {
        difference |= static_cast<unsigned>(given[i] ^ secret[i % secret.size()]);
    }
    return difference == 0;
}

/// The value of "token=" in the query of a request's target; "" without one.
std::string_view token_of(std::string_view target) {
    constexpr std::string_view key = "token=";
    std::size_t at = target.find('?');
    while (at != std::string_view::npos) {
        target.remove_prefix(at + 1);
        at = target.find('&');
        if (target.starts_with(key)) {
            return target.substr(0, at).substr(key.size());
        }
    }
    return "";
}

/// Whether a path, without its first '/', is as Handlers::get promises. Percent-encoding has no place in it.
bool is_clean(std::string_view path) {
    char before = '/';
    for (char const c : path) {
        bool const begins_badly = before == '/' && (c == '/' || c == '.');
        if (begins_badly || !(is_letter_or_digit(c) || c == '/' || c == '.' || c == '_' || c == '-')) {
            return false;
        }
        before = c;
    }
    return path.empty() || before != '/';
}

Response response_of(status code, Answer answer) {
    Response response(code, 11);
    response.set(http::field::connection, "close");
    response.set(http::field::content_type, answer.type);
    response.set(http::field::cache_control, "no-store");
    response.set("Content-Security-Policy", answer.policy);
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.set("Referrer-Policy", "no-referrer");
    response.set("X-Content-Type-Options", "nosniff");
    if (code == status::method_not_allowed) {
        response.set(http::field::allow, "GET, HEAD");
    }
    response.content_length(answer.bytes.size());
    response.body() = std::move(answer.bytes);
    return response;
}

Response in_words(status code, std::string words) {
    return response_of(code, {.bytes = std::move(words) + "\n", .type = "text/plain; charset=utf-8"});
}

struct Message {
    std::shared_ptr<std::string const> bytes;
    bool is_text = false;

    std::int64_t bytes_in_queue() const { return static_cast<std::int64_t>(bytes->size() + 64); } // its own 64
};

void check(ServeParams const& params) {
    constexpr std::string_view function = "serve.Server";
    constexpr double hour_ms = 3600000.0;
    bool const is_plain =
        std::ranges::all_of(params.token, [](char c) { return is_letter_or_digit(c) || c == '-' || c == '_'; });
    refuse_if<BadParameter>(params.token.size() < 16 || !is_plain, function,
                            "the token must have at least 16 letters, digits, '-' or '_', as new_token() gives them");
    require_in(function, "connections", params.connections, Range::between(1, 100000));
    require_in(function, "message_bytes", params.message_bytes, Range::between(1, 1 << 30));
    require_in(function, "queue_bytes", params.queue_bytes, Range::between(1, static_cast<double>(1LL << 40)));
    require_in(function, "request_time", std::int64_t{params.request_time.count()}, Range::between(1, hour_ms), "ms");
    require_in(function, "silence", std::int64_t{params.silence.count()}, Range::between(1, hour_ms), "ms");
}

} // namespace

class Session;
class Exchange;

/// The socket that accepts connections, and what they share.
class Listener {
public:
    Listener(ServeParams given, Handlers called);
    void run(std::stop_token const& stop);
    void send(Client to, Message const& message);

    ServeParams const params;
    Handlers const handlers;
    int connections = 0;                ///< open now, of programs that have shown the token
    std::list<Exchange*> strangers;     ///< connections that have not, the oldest first
    std::mutex mutex;                   ///< of clients and their queues
    std::map<Client, Session*> clients; ///< opened and not yet closed
    Client last = 0;
    asio::io_context io{1};
    std::string host; ///< 127.0.0.1:PORT

private:
    void accept();
    void admit(tcp::socket socket);

    tcp::acceptor acceptor_{io};
    asio::steady_timer pause_{io};
};

/// Counts a connection while it is open.
class ConnectionCount {
public:
    explicit ConnectionCount(int& connections) : connections_(connections) { ++connections_; }
    ~ConnectionCount() { --connections_; }
    ConnectionCount(ConnectionCount const&) = delete;
    ConnectionCount& operator=(ConnectionCount const&) = delete;

private:
    int& connections_;
};

/// A WebSocket connection. It lives as long as an operation on it is pending.
class Session : public std::enable_shared_from_this<Session> {
public:
    Session(Listener& listener, beast::tcp_stream&& stream)
        : listener_(listener), counted_(listener.connections), socket_(std::move(stream)) {}
    ~Session() {
        std::lock_guard const lock(listener_.mutex);
        listener_.clients.erase(id_); // where a handler's exception ends all
    }
    Session(Session const&) = delete;
    Session& operator=(Session const&) = delete;

    void open(Request const& request) {
        beast::get_lowest_layer(socket_).expires_never();
        socket_.set_option(
            websocket::stream_base::timeout{listener_.params.request_time, listener_.params.silence, true});
        socket_.read_message_max(static_cast<std::size_t>(listener_.params.message_bytes));
        socket_.auto_fragment(false);
        socket_.async_accept(request, [self = shared_from_this()](error_code error) {
            if (!error) {
                self->enter();
            }
        });
    }

    /// Adds a message to the queue. The caller holds the mutex.
    void enqueue(Message const& message) {
        waiting_ += message.bytes_in_queue();
        if (is_dropped_) {
            return;
        }
        if (waiting_ > listener_.params.queue_bytes) {
            is_dropped_ = true;
            queue_.clear();
            asio::post(listener_.io, [self = shared_from_this()] { self->end("it reads too slowly"); });
            return;
        }
        queue_.push_back(message);
        if (!is_writing_) {
            is_writing_ = true;
            asio::post(listener_.io, [self = shared_from_this()] { self->write(); });
        }
    }

    void begin_closing() {
        websocket::close_reason const why(websocket::close_code::going_away, "the program ends");
        socket_.async_close(why, [self = shared_from_this()](error_code) { self->end("the program ends"); });
    }

    void end(std::string_view why) {
        {
            std::lock_guard const lock(listener_.mutex);
            if (listener_.clients.erase(id_) == 0) {
                return;
            }
            is_dropped_ = true;
            queue_.clear();
        }
        beast::get_lowest_layer(socket_).close();
        if (listener_.handlers.closed) {
            listener_.handlers.closed(id_, why);
        }
    }

private:
    void enter() {
        {
            std::lock_guard const lock(listener_.mutex);
            id_ = ++listener_.last;
            listener_.clients.emplace(id_, this);
        }
        if (listener_.handlers.opened) {
            listener_.handlers.opened(id_);
        }
        read();
    }

    void read() {
        socket_.async_read(received_, [self = shared_from_this()](error_code error, std::size_t) {
            if (error) {
                self->end(error == websocket::error::closed ? "it left" : error.message());
                return;
            }
            self->pass_on();
            self->received_ = {};
            self->read();
        });
    }

    void pass_on() const {
        auto const& handler = socket_.got_text() ? listener_.handlers.text : listener_.handlers.binary;
        if (handler) {
            handler(id_, {static_cast<char const*>(received_.cdata().data()), received_.size()});
        }
    }

    void write() {
        Message next;
        {
            std::lock_guard const lock(listener_.mutex);
            is_writing_ = !queue_.empty();
            if (!is_writing_) {
                return;
            }
            next = queue_.front();
        }
        socket_.text(next.is_text);
        auto const bytes = asio::buffer(*next.bytes);
        socket_.async_write(bytes, [self = shared_from_this(), next](error_code error, std::size_t) {
            if (error) {
                return; // reading fails as well, and says why
            }
            {
                std::lock_guard const lock(self->listener_.mutex);
                if (self->is_dropped_) {
                    return;
                }
                self->queue_.pop_front();
                self->waiting_ -= next.bytes_in_queue();
            }
            self->write();
        });
    }

    Listener& listener_;
    ConnectionCount counted_;
    Client id_ = 0;
    websocket::stream<beast::tcp_stream, false> socket_; ///< without compression: it is slower than the loopback
    beast::flat_buffer received_;
    std::deque<Message> queue_; ///< the first is being written
    std::int64_t waiting_ = 0;  ///< bytes in the queue
    bool is_writing_ = false;
    bool is_dropped_ = false;
};

/// A connection with one request, which is answered or becomes a Session.
class Exchange : public std::enable_shared_from_this<Exchange> {
public:
    Exchange(Listener& listener, tcp::socket socket) : listener_(listener), stream_(std::move(socket)) {
        place_ = listener_.strangers.insert(listener_.strangers.end(), this);
    }
    ~Exchange() { know(); }
    Exchange(Exchange const&) = delete;
    Exchange& operator=(Exchange const&) = delete;

    /// Closes the connection to make room for others.
    void give_up() {
        know();
        stream_.close();
    }

    void read() {
        parser_.header_limit(most_head_bytes);
        parser_.body_limit(std::numeric_limits<std::uint64_t>::max()); // none is read
        stream_.expires_after(listener_.params.request_time);
        http::async_read_header(stream_, received_, parser_,
                                [self = shared_from_this()](error_code error, std::size_t) { self->answer(error); });
    }

private:
    void answer(error_code error) {
        bool const is_too_long = error == http::error::header_limit || error == http::error::buffer_overflow;
        if (is_too_long) {
            write(in_words(status::request_header_fields_too_large, "The header of this request is too long."));
        } else if (error && error.category() == make_error_code(http::error::bad_method).category()) {
            write(in_words(status::bad_request, "This is not an HTTP request."));
        } else if (!error) { // else the client left or was too slow
            answer(parser_.get());
        }
    }

    void answer(Request const& request) {
        std::string_view const target = view_of(request.target());
        std::string_view const path = target.substr(0, target.find('?'));
        bool const is_upgrade = websocket::is_upgrade(request);
        if (std::optional<Response> refusal = refusal_of(request)) {
            write(std::move(*refusal));
        } else if (path.empty() || path[0] != '/' || !is_clean(path.substr(1))) {
            write(in_words(status::bad_request, "Paths have letters, digits, '.', '_', '-' and '/', no part of them "
                                                "empty or with '.' in front."));
        } else if (listener_.connections >= listener_.params.connections) {
            write(in_words(status::service_unavailable, "Too many connections are open. Close other windows."));
        } else if (is_upgrade && path == "/") {
            know();
            std::make_shared<Session>(listener_, std::move(stream_))->open(request);
        } else {
            know();
            counted_.emplace(listener_.connections);
            write(is_upgrade ? in_words(status::not_found, "There is nothing at this path.")
                             : found_at(std::string(path.substr(1))));
        }
    }

    /// From now on the connection is not closed for others.
    void know() {
        if (place_) {
            listener_.strangers.erase(*place_);
            place_.reset();
        }
    }

    Response found_at(std::string const& path) const {
        try {
            std::optional<Answer> found =
                listener_.handlers.get ? listener_.handlers.get(path) : std::optional<Answer>();
            return found ? response_of(status::ok, std::move(*found))
                         : in_words(status::not_found, "There is nothing at this path.");
        } catch (Error const& error) { // a file that is gone, perhaps
            return in_words(status::not_found, error.what());
        } catch (std::bad_alloc const&) {
            return in_words(status::internal_server_error, "There is not enough memory to send this.");
        }
    }

    /// The response to a request that is not allowed; nothing where it is.
    std::optional<Response> refusal_of(Request const& request) const {
        std::string const& host = listener_.host;
        if (request.count(http::field::host) != 1 || view_of(request[http::field::host]) != host) {
            return in_words(status::forbidden, "This server answers only at http://" + host + ".");
        }
        auto const origins = request.equal_range(http::field::origin);
        if (std::any_of(origins.first, origins.second,
                        [&](auto const& origin) { return view_of(origin.value()) != "http://" + host; })) {
            return in_words(status::forbidden, "Pages of other sites must not use this server.");
        }
        if (!is_same_secret(token_of(view_of(request.target())), listener_.params.token)) {
            return in_words(
                status::forbidden,
                "The token in this address is missing or wrong. Open the address that the program printed.");
        }
        if (request.method() != http::verb::get && request.method() != http::verb::head) {
            return in_words(status::method_not_allowed, "This server answers only GET and HEAD.");
        }
        if (parser_.chunked() || parser_.content_length().value_or(0) > 0) {
            return in_words(status::payload_too_large, "Requests must not have a body.");
        }
        return std::nullopt;
    }

    void write(Response response) {
        if (parser_.is_header_done() && parser_.get().method() == http::verb::head) {
            response.body().clear();
        }
        response_ = std::move(response);
        stream_.expires_after(listener_.params.silence);
        http::async_write(stream_, response_, [self = shared_from_this()](error_code error, std::size_t) {
            if (!error) {
                error_code ignored;
                self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                self->stream_.expires_after(closing_time);
                self->discard();
            }
        });
    }

    /// Reads a little more: closed at once, the connection would be reset before a client that still sends has read.
    void discard() {
        stream_.async_read_some(asio::buffer(discarded_),
                                [self = shared_from_this()](error_code error, std::size_t count) {
                                    self->unread_ += count;
                                    if (!error && self->unread_ < most_unread_bytes) {
                                        self->discard();
                                    }
                                });
    }

    Listener& listener_;
    std::optional<std::list<Exchange*>::iterator> place_; ///< among the strangers
    std::optional<ConnectionCount> counted_;              ///< when it is none any more
    beast::tcp_stream stream_;
    beast::flat_buffer received_{most_head_bytes + 1};
    http::request_parser<http::empty_body> parser_;
    Response response_;
    std::array<char, 4096> discarded_{};
    std::size_t unread_ = 0;
};

Listener::Listener(ServeParams given, Handlers called) : params(std::move(given)), handlers(std::move(called)) {
    check(params);
    try {
        acceptor_.open(tcp::v4());
        acceptor_.set_option(tcp::acceptor::reuse_address(true)); // else a port rests for a minute after its last use
        acceptor_.bind({asio::ip::address_v4::loopback(), params.port});
        acceptor_.listen();
    } catch (boost::system::system_error const& error) {
        throw IoError("serve.Server",
                      fmt::format("cannot listen at port {}: {}; choose another port, or 0 for any free one",
                                  params.port, error.code().message()));
    }
    host = fmt::format("127.0.0.1:{}", acceptor_.local_endpoint().port());
}

void Listener::run(std::stop_token const& stop) {
    accept();
    {
        std::stop_callback const at_stop(stop, [this] { io.stop(); });
        io.run();
    }
    acceptor_.close();
    pause_.cancel();
    std::vector<Session*> left; // closing may end a session at once
    for (auto const& [id, session] : clients) {
        left.push_back(session);
    }
    for (Session* const session : left) {
        session->begin_closing();
    }
    io.restart();
    io.run_for(closing_time); // returns as soon as nothing is left to do
    while (!clients.empty()) {
        clients.begin()->second->end("the program ends");
    }
}

void Listener::send(Client to, Message const& message) {
    std::lock_guard const lock(mutex);
    auto const begin = to == everyone ? clients.begin() : clients.lower_bound(to);
    auto const end = to == everyone ? clients.end() : clients.upper_bound(to);
    std::for_each(begin, end, [&](auto const& client) { client.second->enqueue(message); });
}

void Listener::accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
        if (!acceptor_.is_open()) {
            return;
        }
        if (error) { // no file descriptor is left, perhaps
            pause_.expires_after(std::chrono::milliseconds(50));
            pause_.async_wait([this](error_code cancelled) {
                if (!cancelled) {
                    accept();
                }
            });
            return;
        }
        admit(std::move(socket));
        accept();
    });
}

void Listener::admit(tcp::socket socket) {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    // Who does not know the token keeps others out only as long as they are fewer: a request comes whole within
    // milliseconds, and the connection that has waited longest goes first.
    while (strangers.size() >= most_strangers) {
        strangers.front()->give_up();
    }
    std::make_shared<Exchange>(*this, std::move(socket))->read();
}

std::string new_token() {
    std::array<unsigned char, 16> random{};
    std::string token;
    refuse_if<IoError>(getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size()),
                       "serve.new_token", "the system gives no random bytes");
    for (unsigned char const byte : random) {
        token += fmt::format("{:02x}", byte);
    }
    return token;
}

Server::Server(ServeParams params, Handlers handlers)
    : listener_(std::make_unique<Listener>(std::move(params), std::move(handlers))) {}

Server::~Server() = default;

std::string Server::address() const {
    return "http://" + listener_->host + "/?token=" + listener_->params.token;
}

void Server::run(std::stop_token const& stop) {
    listener_->run(stop);
}

void Server::send_text(Client to, std::string text) {
    listener_->send(to, {std::make_shared<std::string const>(std::move(text)), true});
}

void Server::send_binary(Client to, std::string bytes) {
    listener_->send(to, {std::make_shared<std::string const>(std::move(bytes)), false});
}

} // namespace thalweg::serve
