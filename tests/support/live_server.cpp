#include "tests/support/live_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <utility>

namespace grainsweep::tests {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

std::vector<std::string> into_a_file(std::vector<std::string> command) {
    command.insert(command.begin(), {"/bin/sh", "-c", R"(exec "$0" "$@" > address)"});
    return command;
}

}  // namespace

Connected::Connected(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) return;
    ::close(socket_);
    socket_ = -1;
}
Connected::~Connected() {
    if (socket_ >= 0) ::close(socket_);
}
Connected::Connected(Connected&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}

bool Connected::send(std::string_view bytes) const {
    while (!bytes.empty()) {
        const auto count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

std::optional<std::string> Connected::receive(std::chrono::milliseconds at_most) const {
    pollfd ready{socket_, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(at_most.count())) <= 0) return "";
    std::string bytes(1U << 16U, '\0');
    const auto count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (count <= 0) return std::nullopt;
    bytes.resize(static_cast<std::size_t>(count));
    return bytes;
}

HttpSeen Connected::answer() const {
    constexpr std::string_view length_field = "Content-Length: ";
    std::string text;
    for (const auto last = Clock::now() + 30s; Clock::now() < last;) {
        const auto more = receive(100ms);
        if (more) text += *more;
        const auto end = text.find("\r\n\r\n"), at = text.find(length_field);
        const bool whole = end != std::string::npos && at < end &&
                           text.size() - end - 4 >= std::stoul(text.substr(at + length_field.size()));
        if (!whole && more) continue;
        if (end == std::string::npos) return {};
        return {std::stoi(text.substr(text.find(' ') + 1)), text.substr(0, end), text.substr(end + 4)};
    }
    return {};
}

LiveServer::LiveServer(const Folder& folder, const std::string& place, const std::vector<std::string>& options)
    : process_(into_a_file([&] {
                   auto arguments = options;
                   arguments.insert(arguments.begin(), {"serve", place, "--port", "0"});
                   return program_command(arguments);
               }()),
               folder.path()) {
    std::string line;
    while (process_.running() && line.find("token=") == std::string::npos) {
        std::this_thread::sleep_for(5ms);
        std::ifstream file(folder / "address");
        std::getline(file, line);
        if (file.eof()) line.clear();  // half a line
    }
    if (line.empty()) throw std::runtime_error("no address: " + process_.wait().err);
    port_ = static_cast<std::uint16_t>(std::stoi(line.substr(line.rfind(':') + 1)));
    token_ = line.substr(line.find('=') + 1);
}

std::string LiveServer::address() const {
    return fmt::format("http://127.0.0.1:{}/?token={}", port_, token_);
}

std::string LiveServer::request(std::string_view method, const std::string& path, const std::string& query,
                                std::string_view body, std::string_view headers) const {
    return fmt::format("{} {}?token={}&{} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}{}\r\n{}", method, path, token_, query,
                       port_, headers, method == "POST" ? fmt::format("Content-Length: {}\r\n", body.size()) : "",
                       body);
}

HttpSeen LiveServer::get(const std::string& path, const std::string& query) const {
    const Connected client(port_);
    client.send(request("GET", path, query));
    return client.answer();
}

HttpSeen LiveServer::post(const std::string& path, const std::string& query, std::string_view body) const {
    const Connected client(port_);
    client.send(request("POST", path, query, body));
    return client.answer();
}

HttpSeen LiveServer::work(const std::string& path, const std::string& query, std::string_view body) const {
    auto seen = post(path, query, body);
    if (seen.status != 200) return seen;
    const auto begun = nlohmann::json::parse(seen.body);
    if (!begun.contains("job")) return seen;
    do {
        std::this_thread::sleep_for(20ms);
        seen = get("/job", fmt::format("number={}", begun["job"].get<int>()));
    } while (seen.status == 200 && nlohmann::json::parse(seen.body).contains("running"));
    return seen;
}

Connected LiveServer::events(const std::string& since) const {
    Connected stream(port_);
    auto text = request("GET", "/events", "since=" + since);
    text.replace(text.find("HTTP/1.1"), 8, "HTTP/1.0");  // events as they are, not in chunks
    stream.send(text);
    return stream;
}

}  // namespace grainsweep::tests
