// Small HTTP server for this machine only (GNU libmicrohttpd). The thread that calls run() answers requests one after
// the other. Streams send events (Server-sent events, WHATWG HTML section 9.2).
//
// It listens on 127.0.0.1 only. Limits for clients: connections, bytes of a request, seconds of a request and of
// silence, and pending bytes of a slow stream. Of the connections whose requests were all refused, the server
// keeps the latest few.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

namespace grainsweep::live {

struct HttpQuestion {
    std::string method, path;
    std::map<std::string, std::string, std::less<>> query;
    std::string host, origin, last_event;  ///< header fields Host, Origin and Last-Event-ID
    std::string body;
    bool too_large = false;  ///< the body has more than HttpServer::most_body bytes and is omitted
};

struct HttpAnswer {
    unsigned status = 200;
    std::string type = "text/plain; charset=utf-8";
    std::shared_ptr<const std::string> body = nullptr;
    std::string policy = {};  ///< content security policy
};

/// Response that keeps the connection open for events, beginning with these.
struct HttpStream {
    std::string first;
};

using HttpReply = std::variant<HttpAnswer, HttpStream>;

class HttpServer {
public:
    HttpServer() = default;
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;
    virtual ~HttpServer() = default;

    static constexpr std::size_t most_body = 64U << 10U;
    static constexpr unsigned most_connections = 256;
    static constexpr unsigned most_strangers = 64;              ///< most connections of which no request was answered
    static constexpr std::chrono::seconds longest_request{10};  ///< until its last byte is there
    static constexpr std::size_t most_waiting = 8U << 20U;      ///< most pending bytes of a stream

    [[nodiscard]] virtual std::uint16_t port() const = 0;
    /// Answers pending requests; waits at most this time for the first one.
    virtual void run(std::chrono::milliseconds at_most) = 0;
    /// Sends events to every open stream. A stream with a slow reader is closed.
    virtual void publish(std::string_view events) = 0;
    [[nodiscard]] virtual std::size_t streams() const = 0;
};

using Respond = std::function<HttpReply(const HttpQuestion&)>;

/// Opens a server. Port 0: any free port. Throws SystemError if the port is not available.
[[nodiscard]] std::unique_ptr<HttpServer> open_http_server(std::uint16_t port, Respond respond);

}  // namespace grainsweep::live
