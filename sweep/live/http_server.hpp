// A small HTTP server for this machine alone (GNU libmicrohttpd): questions answered one after the other by the thread
// that calls run(), and streams of events (Server-sent events, WHATWG HTML section 9.2).
//
// It listens on 127.0.0.1 only and bounds what a client may take: connections, bytes of a question, seconds of silence,
// bytes that wait for a slow reader of a stream.
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
    bool too_large = false;  ///< the body has more than HttpServer::most_body bytes and is left out
};

struct HttpAnswer {
    unsigned status = 200;
    std::string type = "text/plain; charset=utf-8";
    std::shared_ptr<const std::string> body = nullptr;
    std::string policy = {};  ///< content security policy
};

/// The connection stays open for events; these come first.
struct HttpStream {
    std::string first;
};

using HttpReply = std::variant<HttpAnswer, HttpStream>;

class HttpServer {
public:
    static constexpr std::size_t most_body = 64U << 10U;
    static constexpr unsigned most_connections = 200;
    static constexpr std::size_t most_waiting = 8U << 20U;  ///< bytes of a stream that its reader has not taken

    using Respond = std::function<HttpReply(const HttpQuestion&)>;
    /// Port 0: any that is free. Throws BrokenWorld where the port cannot be had.
    HttpServer(std::uint16_t port, Respond respond);
    ~HttpServer();

    [[nodiscard]] std::uint16_t port() const;
    /// Answers what has come, and waits at most so long for the first question.
    void run(std::chrono::milliseconds at_most);
    /// To every open stream. One whose reader is far behind is closed.
    void publish(std::string_view events);
    [[nodiscard]] std::size_t streams() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace grainsweep::live
