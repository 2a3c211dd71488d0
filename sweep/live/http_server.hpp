// Small HTTP server for this machine only (GNU libmicrohttpd). The thread that calls run() answers requests one after
// the other. Streams send events (Server-sent events, WHATWG HTML section 9.2).
//
// It listens on 127.0.0.1 only. Limits for clients: connections, bytes of a request, seconds of silence, and pending
// bytes of a slow stream.
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
    static constexpr std::size_t most_body = 64U << 10U;
    static constexpr unsigned most_connections = 200;
    static constexpr std::size_t most_waiting = 8U << 20U;  ///< most pending bytes of a stream

    using Respond = std::function<HttpReply(const HttpQuestion&)>;
    /// Port 0: any free port. Throws BrokenWorld if the port is not available.
    HttpServer(std::uint16_t port, Respond respond);
    ~HttpServer();

    [[nodiscard]] std::uint16_t port() const;
    /// Answers pending requests; waits at most this time for the first one.
    void run(std::chrono::milliseconds at_most);
    /// Sends events to every open stream. A stream with a slow reader is closed.
    void publish(std::string_view events);
    [[nodiscard]] std::size_t streams() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace grainsweep::live
