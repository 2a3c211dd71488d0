// `grainsweep serve` as a process, and a client that sends it whatever bytes a test likes.
#pragma once

#include "tests/support/process.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::tests {

struct HttpSeen {
    int status = 0;  ///< 0: no answer
    std::string head, body;
};

/// A TCP connection to this machine.
class Connected {
public:
    explicit Connected(std::uint16_t port);
    ~Connected();
    Connected(Connected&& other) noexcept;
    Connected(const Connected&) = delete;
    Connected& operator=(const Connected&) = delete;

    [[nodiscard]] bool is_open() const { return socket_ >= 0; }
    /// False where the other side does not take it.
    bool send(std::string_view bytes) const;
    /// What comes within the time; nothing where the other side has closed.
    [[nodiscard]] std::optional<std::string> receive(std::chrono::milliseconds at_most) const;
    /// All that comes until the answer is whole, at most 30 s.
    [[nodiscard]] HttpSeen answer() const;

private:
    int socket_ = -1;
};

/// The server, on a free port; it ends with this object.
class LiveServer {
public:
    /// `place`: database or folder. Throws std::runtime_error where no address is printed.
    LiveServer(const Folder& folder, const std::string& place, const std::vector<std::string>& options = {});

    [[nodiscard]] std::uint16_t port() const { return port_; }
    [[nodiscard]] const std::string& token() const { return token_; }
    [[nodiscard]] Process& process() { return process_; }
    [[nodiscard]] std::string address() const;

    /// The text of a request with these header lines ("Name: value\r\n").
    [[nodiscard]] std::string request(std::string_view method, const std::string& path, const std::string& query,
                                      std::string_view body = {}, std::string_view headers = {}) const;
    [[nodiscard]] HttpSeen get(const std::string& path, const std::string& query = {}) const;
    [[nodiscard]] HttpSeen post(const std::string& path, const std::string& query, std::string_view body = {}) const;
    /// Asks for work and waits for its end.
    [[nodiscard]] HttpSeen work(const std::string& path, const std::string& query, std::string_view body = {}) const;
    /// A stream of events that is open.
    [[nodiscard]] Connected events(const std::string& since = {}) const;

private:
    Process process_;
    std::uint16_t port_ = 0;
    std::string token_;
};

}  // namespace grainsweep::tests
